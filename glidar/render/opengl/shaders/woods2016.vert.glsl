// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Projects the corners of triangles into the image, with all inputs of their shading.

layout(location = 0) in vec3 position;  // relative to the mesh's origin
layout(location = 3) in vec3 normal;
uniform mat4 clip_from_object;
uniform vec4 steps_from_object;
uniform vec3 sensor;  // in the mesh's units, relative to its origin
uniform float metres_per_unit;

// The same bits from every program, so that surfaces drawn by two of them leave no gap.
invariant gl_Position;

out vec3 at_normal;
out float depth_steps;  // D of equation (8)
out vec3 ray;           // from the sensor, metres
#ifdef HAS_TEXTURES
layout(location = 1) in vec2 uv_0;
layout(location = 2) in vec2 uv_1;
layout(location = 4) in vec4 tangent;
layout(location = 5) in vec3 colour;
out vec2 at_uv_0;
out vec2 at_uv_1;
out vec4 at_tangent;
out vec3 at_colour;
#endif
#ifdef WRITES_DEPTH
out float clip_depth;
#endif

void main() {
  vec4 place = vec4(position, 1.0);
  gl_Position = clip_from_object * place;
  depth_steps = dot(steps_from_object, place);
  ray = metres_per_unit * (position - sensor);
  at_normal = normal;
#ifdef HAS_TEXTURES
  at_uv_0 = uv_0;
  at_uv_1 = uv_1;
  at_tangent = tangent;
  at_colour = colour;
#endif
#ifdef WRITES_DEPTH
  clip_depth = gl_Position.z;
#endif
}
