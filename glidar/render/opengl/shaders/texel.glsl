// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Looks textures up as sample() in core/material.cpp does, texel by texel: the weights of a
// driver's own filter have few bits.

struct TextureUse {
  mat2 uv_scale_rotate;
  vec2 uv_offset;
  ivec2 wrap;      // of u and v: 0 repeat, 1 mirror, 2 clamp
  bool is_linear;  // else nearest
};

int wrapped(int index, int size, int wrap) {
  if (wrap == 2) return clamp(index, 0, size - 1);
  int period = wrap == 0 ? size : 2 * size;
  int i = index >= 0 ? index % period : period - 1 - (-1 - index) % period;
  return i >= size ? period - 1 - i : i;
}

vec4 texel(sampler2D image, TextureUse use, ivec2 size, vec2 at) {
  ivec2 place = ivec2(wrapped(int(at.x), size.x, use.wrap.x), wrapped(int(at.y), size.y, use.wrap.y));
  return texelFetch(image, place, 0);
}

vec4 texel_at(sampler2D image, TextureUse use, vec2 uv) {
  ivec2 size = textureSize(image, 0);
  vec2 at = use.uv_scale_rotate * uv + use.uv_offset;
  // Row 0 is the top row, v is upwards.
  vec2 place = clamp(vec2(at.x, 1.0 - at.y) * vec2(size), -1e9, 1e9);
  if (!use.is_linear) return texel(image, use, size, floor(place));
  vec2 corner = floor(place - 0.5);
  vec2 part = place - 0.5 - corner;
  vec4 upper = mix(texel(image, use, size, corner), texel(image, use, size, corner + vec2(1.0, 0.0)),
                   part.x);
  vec4 lower = mix(texel(image, use, size, corner + vec2(0.0, 1.0)),
                   texel(image, use, size, corner + vec2(1.0, 1.0)), part.x);
  return mix(upper, lower, part.y);
}
