// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
in vec4 vertex_colour;
layout(location = 0) out vec4 pixel;

void main() {
  pixel = vertex_colour;
}
