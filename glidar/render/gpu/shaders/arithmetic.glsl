// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Resolver's arithmetic, each operation rounded once and in the same order.

double ordered_dot(dvec3 a, dvec3 b) {
  precise double sum = a.x * b.x + a.y * b.y + a.z * b.z;
  return sum;
}

// As rays_in(): the matrix is given by its rows.
dvec3 turned(dvec3 row_x, dvec3 row_y, dvec3 row_z, dvec3 v) {
  return dvec3(ordered_dot(row_x, v), ordered_dot(row_y, v), ordered_dot(row_z, v));
}

dvec3 moved_origin(dvec3 sensor, dvec3 offset, double metres_per_unit) {
  precise dvec3 origin = sensor + offset / metres_per_unit;
  return origin;
}

// As intersect_planes().
double distance_to(dvec4 plane, dvec3 origin, double cosine) {
  precise double above = plane.w - ordered_dot(plane.xyz, origin);
  precise double distance = above / cosine;
  return distance;
}

double range_along(double distance, double metres_per_unit) {
  precise double range = distance * metres_per_unit;
  return range;
}
