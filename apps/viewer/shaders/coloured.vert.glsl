// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Points and lines with their own colours.
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 colour;
uniform mat4 clip_from_anchor;
uniform float point_size;
out vec4 vertex_colour;

void main() {
  gl_Position = clip_from_anchor * vec4(position, 1.0);
  gl_PointSize = point_size;
  vertex_colour = colour;
}
