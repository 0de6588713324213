// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Ranges for given numbers, to be compared with the processor's.

layout(local_size_x = 64) in;

struct Case {
  dvec4 row_x;
  dvec4 row_y;
  dvec4 row_z;
  dvec4 sensor;  // and metres per object unit
  dvec4 beam;
  dvec4 offset;  // of the beam's origin
  dvec4 plane;
};
layout(std430, binding = 0) readonly buffer Cases { Case cases[]; };
layout(std430, binding = 1) writeonly buffer Results { double results[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  Case c = cases[i];
  dvec3 direction = turned(c.row_x.xyz, c.row_y.xyz, c.row_z.xyz, c.beam.xyz);
  dvec3 offset = turned(c.row_x.xyz, c.row_y.xyz, c.row_z.xyz, c.offset.xyz);
  dvec3 origin = moved_origin(c.sensor.xyz, offset, c.sensor.w);
  double distance = distance_to(c.plane, origin, ordered_dot(c.plane.xyz, direction));
  results[i] = range_along(distance, c.sensor.w);
}
