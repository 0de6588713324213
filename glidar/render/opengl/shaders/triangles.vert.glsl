// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Projects the corners of triangles into the image.

layout(location = 0) in vec3 position;  // relative to the mesh's origin
uniform mat4 clip_from_object;

// The same bits from every program, so that surfaces drawn by two of them leave no gap.
invariant gl_Position;

#ifdef HAS_MASK
layout(location = 1) in vec2 uv;
out vec2 mask_uv;
#endif
#ifdef WRITES_DEPTH
out float clip_depth;
#endif

void main() {
  gl_Position = clip_from_object * vec4(position, 1.0);
#ifdef HAS_MASK
  mask_uv = uv;
#endif
#ifdef WRITES_DEPTH
  clip_depth = gl_Position.z;
#endif
}
