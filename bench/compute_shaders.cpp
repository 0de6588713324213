// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "compute_shaders.hpp"

namespace glidar::bench {
namespace {

/// Resolver's arithmetic, each operation rounded once and in the same order.
constexpr const char* kArithmetic = R"(
double ordered_dot(dvec3 a, dvec3 b) {
  precise double sum = a.x * b.x + a.y * b.y + a.z * b.z;
  return sum;
}

// As rays_in(): the matrix is given by its rows.
dvec3 turned(dvec3 row_x, dvec3 row_y, dvec3 row_z, dvec3 v) {
  return dvec3(ordered_dot(row_x, v), ordered_dot(row_y, v), ordered_dot(row_z, v));
}

// As intersect_planes().
double distance_to(dvec4 plane, dvec3 origin, double cosine) {
  precise double above = plane.w - ordered_dot(plane.xyz, origin);
  precise double distance = above / cosine;
  return distance;
}
)";

constexpr const char* kData = R"(
struct View {
  dvec4 row_x;  // from the sensor to the object
  dvec4 row_y;
  dvec4 row_z;
  dvec4 sensor;  // where it is, object units; metres per object unit
};
layout(std430, binding = 0) readonly buffer Nodes { vec4 nodes[]; };          // 16 each
layout(std430, binding = 1) readonly buffer Triangles { vec4 corners[]; };    // 3 each
layout(std430, binding = 2) readonly buffer Planes { dvec4 planes[]; };       // per primitive
layout(std430, binding = 3) readonly buffer Directions { dvec4 directions[]; };  // per beam
layout(std430, binding = 4) readonly buffer Views { View views[]; };
layout(std430, binding = 5) writeonly buffer Numbers { uint numbers[]; };
layout(std430, binding = 6) writeonly buffer Ranges { double ranges[]; };
layout(std430, binding = 7) buffer Doubts { uint doubt_count; uint doubts[]; };
layout(location = 0) uniform uvec2 size;     // columns and rows
layout(location = 1) uniform dvec4 sphere;   // around the mesh: centre and radius
layout(location = 2) uniform vec2 reach;     // of its vertices: largest coordinate, distance
)";

// Boxes contain the triangles; the ray in single precision differs from the true one by less than
// `padding`, so its origin is an interval of that width.
constexpr const char* kRay = R"(
dvec3 origin;
dvec3 direction;
double shift;      // in single precision the ray starts so far along itself, near the mesh
vec3 start;
vec3 way;
vec3 inverse;
vec3 near_origin;
vec3 far_origin;
uvec3 near_rows;   // of nodes: lower or upper sides of boxes
uvec3 far_rows;
float scaled;      // 25 roundings of the distance of the farthest corner, in the largest coordinate
float behind;      // distances below it are surely negative
float ahead;       // distances above it are surely positive

const float kRounding = 6e-8;  // 2^-24

float largest(vec3 v) { return max(v.x, max(v.y, v.z)); }
float least(vec3 v) { return min(v.x, min(v.y, v.z)); }
float sum_of_sizes(vec3 v) { return abs(v.x) + abs(v.y) + abs(v.z); }
double sum_of_sizes(dvec3 v) { return abs(v.x) + abs(v.y) + abs(v.z); }

void set_ray() {
  shift = max(dot(sphere.xyz - origin, direction) - 1.001lf * sphere.w, 0.0lf);
  dvec3 moved = origin + shift * direction;
  double padding = 5e-7lf * (2.0lf * sum_of_sizes(moved - sphere.xyz) + double(reach.x)) +
                   2e-15lf * (2.0lf * shift + sum_of_sizes(origin));
  start = vec3(moved);
  way = vec3(direction);
  inverse = 1.0 / mix(way, vec3(1e-18), lessThan(abs(way), vec3(1e-18)));
  bvec3 is_negative = lessThan(inverse, vec3(0.0));
  vec3 low = vec3(moved - padding);
  vec3 high = vec3(moved + padding);
  near_origin = mix(high, low, is_negative);
  far_origin = mix(low, high, is_negative);
  near_rows = uvec3(0, 2, 4) + 6u * uvec3(is_negative);
  far_rows = uvec3(6, 8, 10) - 6u * uvec3(is_negative);
  double far = shift + sum_of_sizes(origin) + double(reach.y);
  scaled = 25.0 * kRounding *
           (largest(abs(start)) + reach.x + float(padding) + 3e-7 * float(far) + 1e-12);
  behind = -float(shift) * (1.0 + 1e-6) - 1e-30;
  ahead = -float(shift) * (1.0 - 1e-6) + 1e-30;
}
)";

constexpr const char* kNearest = R"(
const uint kNone = 0xffffffffu;
const float kFar = 1e38;

// Distances from the ray's shift. By the hit rule, that of the nearest triangle that is surely hit
// is between low and high; high includes surfaces that tie.
uint nearest_slot = kNone;
float nearest_low = kFar;
float nearest_high = kFar;
float other_low = kFar;  // no other triangle that may be hit is nearer than this

void take(uint slot, float low, float high) {
  if (high >= nearest_high) {
    other_low = min(other_low, low);
    return;
  }
  other_low = min(other_low, nearest_low);
  nearest_slot = slot;
  nearest_low = low;
  nearest_high = high;
}
)";

// For what single precision leaves in doubt. kRoom is some 2^-42 instead of 24 times 2^-53, which
// has room for the rule's own rounding, of the same form. kTouching exceeds the rule's bounds for
// an origin on the triangle, 2^-44, and kTiePart the rays' 2^-43.
constexpr const char* kDouble = R"(
const double kRoom = 2.5e-13lf;
const double kTouching = 4e-12lf;
const double kTiePart = 1.2e-13lf;

void test_in_double(uint slot, dvec3 a, dvec3 b, dvec3 c) {
  dvec3 from = a - origin;
  dvec3 e1 = b - a;
  dvec3 e2 = c - a;
  dvec3 n = cross(e1, e2);
  double den = dot(direction, n);
  double u = dot(direction, cross(e2, from));
  double v = dot(direction, cross(from, e1));
  double w = den - u - v;
  double s1 = sum_of_sizes(e1);
  double s2 = sum_of_sizes(e2);
  double far = sum_of_sizes(from) + s1 + s2;
  double room = kRoom * (far * (s1 + s2) + s1 * s2);
  double lowest = min(u, min(v, w));
  double highest = max(u, max(v, w));
  if (lowest < -room && highest > room) return;
  double den_room = kRoom * s1 * s2;
  double size = abs(den);
  if (!(size > 4.0lf * den_room)) {  // seen edge-on
    other_low = -kFar;
    return;
  }
  double det = dot(from, n);
  double t = det / den;
  double across = sum_of_sizes(n);
  double error = 1.5lf * (kRoom * far * s1 * s2 + abs(t) * den_room) / size + 1e-12lf * abs(t) +
                 kTiePart * (sum_of_sizes(origin) + double(reach.y)) * across / size;
  float middle = float(t - shift);
  float room_t = 1e-6 * abs(middle) + float(error) * 1.001 + 1e-30;
  if (middle + room_t < behind || middle - room_t > nearest_high) return;
  bool is_inside = lowest > room || highest < -room;
  if (is_inside && t > 0.0lf && abs(det) > kTouching * far * across) {
    take(slot, middle - room_t, middle + room_t);
  } else {
    other_low = min(other_low, middle - room_t);
  }
}
)";

// Single precision: docs/internals/ray-casting.md derives the bounds, with one cluster for all
// triangles. Divisions here may be wrong by 2.5 roundings instead of half of one. The bounds of
// distances hold surfaces that tie.
constexpr const char* kSingle = R"(
void test_triangle(uint slot) {
  vec3 a = corners[3u * slot].xyz;
  vec3 b = corners[3u * slot + 1u].xyz;
  vec3 c = corners[3u * slot + 2u].xyz;
  vec3 from = a - start;
  vec3 e1 = b - a;
  vec3 e2 = c - a;
  vec3 n = cross(e1, e2);
  float den = dot(way, n);
  vec3 edges;
  edges.x = dot(way, cross(e2, from));
  edges.y = dot(way, cross(from, e1));
  edges.z = den - edges.x - edges.y;
  float lowest = least(edges);
  float highest = largest(edges);
  float s1 = sum_of_sizes(e1);
  float s2 = sum_of_sizes(e2);
  float area = s1 * s2 + 1e-18;
  float room = scaled * (s1 + s2) + 25.0 * kRounding * area;
  if (lowest < -room && highest > room) return;
  float den_room = 10.5 * kRounding * area;
  float size = abs(den);
  float t = dot(from, n) / den;
  float error = 1.5 * (0.5 * scaled * area + abs(t) * den_room) / size + 1e-6 * abs(t);
  bool is_known = size > 4.0 * den_room;
  if (is_known && (t - error > nearest_high || t + error < behind)) return;
  bool is_inside = lowest > room || highest < -room;
  if (is_known && is_inside && t - error > ahead) {
    take(slot, t - error, t + error);
  } else {
    test_in_double(slot, dvec3(a), dvec3(b), dvec3(c));
  }
}
)";

// Slabs have two roundings and a division, which may be wrong by 2.5 more.
constexpr const char* kWalk = R"(
const float kSlabRoom = 1.0 + 4e-6;
const float kEntryRoom = 1.0 - 4e-6;
const uint kLeafBit = 0x80000000u;

// What is left to visit: children, and where the ray enters them in the upper 16 bits of a float,
// two per word. Small, since the memory that threads share decides how many of them run at once.
shared uint children[STACK * GROUP];
shared uint entries[STACK / 2u * GROUP];
uint count = 0u;
uint next = 0u;  // child to be visited
float next_entry;

void push(uint child, float entry) {
  if (count == STACK) {
    other_low = -kFar;
    return;
  }
  children[count * GROUP + gl_LocalInvocationIndex] = child;
  uint word = count / 2u * GROUP + gl_LocalInvocationIndex;
  int offset = int(count % 2u) * 16;
  entries[word] = bitfieldInsert(entries[word], floatBitsToUint(entry) >> 16, offset, 16);
  ++count;
}

void pop() {
  next = kNone;
  while (next == kNone && count > 0u) {
    --count;
    uint word = entries[count / 2u * GROUP + gl_LocalInvocationIndex];
    uint entry = bitfieldExtract(word, int(count % 2u) * 16, 16) << 16;
    if (uintBitsToFloat(entry) > nearest_high) continue;
    next = children[count * GROUP + gl_LocalInvocationIndex];
  }
}

// The nearest child is visited next.
void enter(uint child, float first, float last) {
  if (first > last * kSlabRoom || child == kNone) return;
  float entry = first * kEntryRoom;
  if (next == kNone) {
    next = child;
    next_entry = entry;
  } else if (entry < next_entry) {
    push(next, next_entry);
    next = child;
    next_entry = entry;
  } else {
    push(child, entry);
  }
}

void enter_four(uint node) {
  vec4 near_x = (nodes[node + near_rows.x] - near_origin.x) * inverse.x;
  vec4 near_y = (nodes[node + near_rows.y] - near_origin.y) * inverse.y;
  vec4 near_z = (nodes[node + near_rows.z] - near_origin.z) * inverse.z;
  vec4 far_x = (nodes[node + far_rows.x] - far_origin.x) * inverse.x;
  vec4 far_y = (nodes[node + far_rows.y] - far_origin.y) * inverse.y;
  vec4 far_z = (nodes[node + far_rows.z] - far_origin.z) * inverse.z;
  uvec4 child = floatBitsToUint(nodes[node + 12u]);
  vec4 first = max(max(near_x, near_y), max(near_z, vec4(0.0)));
  vec4 last = min(min(far_x, far_y), min(far_z, vec4(nearest_high)));
  enter(child.x, first.x, last.x);
  enter(child.y, first.y, last.y);
  enter(child.z, first.z, last.z);
  enter(child.w, first.w, last.w);
}

void trace() {
  while (next != kNone) {
    uint visited = next;
    if ((visited & kLeafBit) != 0u) {
      uint slot = visited & 0x1ffffffu;
      uint last = slot + (visited >> 25 & 63u);
      for (; slot <= last; ++slot) test_triangle(slot);
      pop();
      continue;
    }
    next = kNone;
    enter_four(16u * visited);
    enter_four(16u * visited + 1u);
    if (next == kNone) pop();
  }
}
)";

constexpr const char* kMain = R"(
const uint kUndecided = 0xfffffffeu;

// The range as Resolver measures it; negative where it asks the rule.
double range_of(dvec4 plane, double metres_per_unit) {
  double cosine = ordered_dot(plane.xyz, direction);
  double distance = distance_to(plane, origin, cosine);
  precise double range = distance * metres_per_unit;
  return abs(cosine) > 1e-6lf && distance > 0.0lf ? range : -1.0lf;
}

void main() {
  uvec3 at = gl_GlobalInvocationID;
  if (at.x >= size.x || at.y >= size.y) return;
  uint beam = at.y * size.x + at.x;
  uint place = at.z * size.x * size.y + beam;
  dvec4 sensor = views[at.z].sensor;
  origin = sensor.xyz;
  direction = turned(views[at.z].row_x.xyz, views[at.z].row_y.xyz, views[at.z].row_z.xyz,
                     directions[beam].xyz);
  set_ray();
  trace();
  uint number = kNone;
  bool is_decided = other_low > nearest_high || (nearest_slot == kNone && other_low == kFar);
  if (nearest_slot != kNone && is_decided) {
    number = floatBitsToUint(corners[3u * nearest_slot].w);
    double range = range_of(planes[number], sensor.w);
    is_decided = range > 0.0lf;
    ranges[place] = range;
  }
  if (!is_decided) {
    number = kUndecided;
    uint entry = atomicAdd(doubt_count, 1u);
    if (entry < uint(doubts.length())) doubts[entry] = place;
  }
  numbers[place] = number;
}
)";

constexpr const char* kArithmeticTest = R"(
layout(local_size_x = 64) in;
struct Case {
  dvec4 row_x;
  dvec4 row_y;
  dvec4 row_z;
  dvec4 sensor;
  dvec4 beam;
  dvec4 plane;
};
layout(std430, binding = 0) readonly buffer Cases { Case cases[]; };
layout(std430, binding = 1) writeonly buffer Results { double results[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  Case c = cases[i];
  dvec3 direction = turned(c.row_x.xyz, c.row_y.xyz, c.row_z.xyz, c.beam.xyz);
  double distance = distance_to(c.plane, c.sensor.xyz, ordered_dot(c.plane.xyz, direction));
  precise double range = distance * c.sensor.w;
  results[i] = range;
}
)";

}  // namespace

std::string caster_shader() {
  const std::string side = std::to_string(kTileSide);
  return "#version 430 core\n#define STACK " + std::to_string(kDeviceStack) + "u\n#define GROUP " +
         std::to_string(kTileSide * kTileSide) + "u\nlayout(local_size_x = " + side +
         ", local_size_y = " + side + ") in;\n" + kArithmetic + kData + kRay + kNearest + kDouble +
         kSingle + kWalk + kMain;
}

std::string arithmetic_shader() {
  return std::string("#version 430 core\n") + kArithmetic + kArithmeticTest;
}

}  // namespace glidar::bench
