// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Writes which triangle is seen.

uniform uint first_id;  // that of the draw's first triangle
layout(location = 0) out uint triangle_id;

#ifdef HAS_MASK
in vec2 mask_uv;
uniform sampler2D mask;  // r: opacity
uniform TextureUse mask_use;
uniform float opacity;
uniform float cutoff;
#endif
#ifdef WRITES_DEPTH
in float clip_depth;
#endif

void main() {
#ifdef HAS_MASK
  if (opacity * texel_at(mask, mask_use, mask_uv).r < cutoff) discard;
#endif
#ifdef WRITES_DEPTH
  gl_FragDepth = clip_depth * gl_FragCoord.w;
#endif
  triangle_id = first_id + uint(gl_PrimitiveID);
}
