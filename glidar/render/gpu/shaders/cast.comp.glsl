// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The first hit of each beam by the hit rule, or "undecided" where single precision and some double
// cannot prove it; the host decides these. A thread casts a beam. docs/internals/gpu.md explains it.

layout(local_size_x = GROUP) in;

// An instance as seen by a sensor; the tree over the instances of a view has one too.
struct Frame {
  dvec4 row_x;  // from the sensor's axes
  dvec4 row_y;
  dvec4 row_z;
  dvec4 sensor;  // where it is, object units; metres per object unit
  dvec4 sphere;  // around all triangles: centre and radius
  vec4 reach;    // largest coordinate of a vertex, its distance from the origin; that of ties
  uvec4 mesh;    // root among the nodes, first plane, slots of materials with masks, instance
};
struct View {
  uint first_frame;
  uint end_frame;   // frames that are visited one after the other
  uint tree_frame;  // kNone: there is no tree
  uint unused;
};
layout(std430, binding = 0) readonly buffer Nodes { vec4 nodes[]; };       // 16 each
layout(std430, binding = 1) readonly buffer Triangles { vec4 corners[]; };  // 3 each
layout(std430, binding = 2) readonly buffer Planes { dvec4 planes[]; };    // per primitive
layout(std430, binding = 3) readonly buffer Beams { double beams[]; };     // directions, origins
layout(std430, binding = 4) readonly buffer Frames { Frame frames[]; };
layout(std430, binding = 5) readonly buffer Views { View views[]; };
layout(std430, binding = 6) readonly buffer TreeNodes { vec4 tree_nodes[]; };  // over instances
layout(std430, binding = 7) writeonly buffer Ids { uint ids[]; };
layout(std430, binding = 8) writeonly buffer Ranges { double ranges[]; };
layout(std430, binding = 9) readonly buffer Targets { uvec2 targets[]; };  // per beam
layout(location = 0) uniform uvec3 grid;   // columns, rows; log2 of a tile's columns
layout(location = 1) uniform uint first_tile;
layout(location = 2) uniform uint wanted;  // bits:
const uint kOrigins = 1u;      // beams have origins
const uint kTargets = 2u;      // beams have targets
const uint kCulls = 4u;        // back faces let beams pass
const uint kRanges = 8u;       // ranges are written
const uint kInstances = 16u;   // instances are written

const uint kNone = 0xffffffffu;
const uint kUndecided = 0xfffffffeu;
const float kFar = 1e38;
const double kFar_m = 1e300lf;
const float kRounding = 6e-8;  // 2^-24

float largest(vec3 v) { return max(v.x, max(v.y, v.z)); }
float least(vec3 v) { return min(v.x, min(v.y, v.z)); }
float sum_of_sizes(vec3 v) { return abs(v.x) + abs(v.y) + abs(v.z); }
double sum_of_sizes(dvec3 v) { return abs(v.x) + abs(v.y) + abs(v.z); }

// The beam in the sensor's frame.
dvec3 beam_direction;
dvec3 beam_origin;

// The nearest hit in all frames before this one, m. By the hit rule, its distance is between low
// and high, which include surfaces that tie.
uint best_slot = kNone;
uint best_frame;
double best_low = kFar_m;
double best_high = kFar_m;
double others_low = kFar_m;  // no other triangle that may be hit is nearer than this

// The beam in the current frame.
uint frame;
dvec3 origin;
dvec3 direction;
double metres_per_unit;
vec4 reach;
uvec4 mesh;
double shift;  // in single precision the ray starts so far along itself, near the mesh
vec3 start;
vec3 way;
vec3 inverse;
vec3 near_origin;
vec3 far_origin;
uvec3 near_rows;  // of nodes: lower or upper sides of boxes
uvec3 far_rows;
float scaled;     // 25 roundings of the distance of the farthest corner, in the largest coordinate
float behind;     // distances below it are surely negative
float ahead;      // distances above it are surely positive
double tie_reach;

// Distances from the ray's shift in the current frame; kNone: the nearest is in another frame.
uint nearest_slot;
float nearest_low;
float nearest_high;
float other_low;

void place_ray(uint at) {
  dvec3 row_x = frames[at].row_x.xyz;
  dvec3 row_y = frames[at].row_y.xyz;
  dvec3 row_z = frames[at].row_z.xyz;
  dvec4 sensor = frames[at].sensor;
  metres_per_unit = sensor.w;
  direction = turned(row_x, row_y, row_z, beam_direction);
  origin = sensor.xyz;
  if ((wanted & kOrigins) != 0u)
    origin = moved_origin(origin, turned(row_x, row_y, row_z, beam_origin), metres_per_unit);
}

// Boxes contain the triangles; the ray in single precision differs from the true one by less than
// `padding`, so its origin is an interval of that width.
void set_ray(dvec4 sphere) {
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
  tie_reach = max(sum_of_sizes(origin) + double(reach.y), double(reach.z));
  double far = shift + tie_reach;
  scaled = 25.0 * kRounding *
           (largest(abs(start)) + reach.x + float(padding) + 3e-7 * float(far) + 1e-12);
  behind = -float(shift) * (1.0 + 1e-6) - 1e-30;
  ahead = -float(shift) * (1.0 - 1e-6) + 1e-30;
}

// A bound in metres as one of the current frame: lower by the sign -1, higher by 1.
float in_frame(double bound, float direction_of_rounding) {
  if (bound >= kFar_m) return kFar;
  double distance = bound / metres_per_unit;
  float rounded = float(distance - shift);
  float margin = 2e-7 * abs(rounded) + float(2e-15lf * (abs(distance) + shift)) + 1e-30;
  return rounded + direction_of_rounding * margin;
}

double in_metres(float bound, double direction_of_rounding) {
  double distance = shift + double(bound);
  return metres_per_unit * (distance + direction_of_rounding * 2e-15lf * (abs(distance) + shift));
}

void enter_frame(uint at) {
  frame = at;
  reach = frames[at].reach;
  mesh = frames[at].mesh;
  place_ray(at);
  set_ray(frames[at].sphere);
  nearest_slot = kNone;
  nearest_low = in_frame(best_low, -1.0);
  nearest_high = in_frame(best_high, 1.0);
  other_low = kFar;
  // Beyond it, single precision overflows.
  if (tie_reach + shift > 1e17lf) others_low = -kFar_m;
}

void leave_frame() {
  if (other_low <= -kFar) {
    others_low = -kFar_m;
  } else if (other_low < kFar) {
    others_low = min(others_low, in_metres(other_low, -1.0lf));
  }
  if (nearest_slot == kNone) return;
  best_slot = nearest_slot;
  best_frame = frame;
  best_low = in_metres(nearest_low, -1.0lf);
  best_high = in_metres(nearest_high, 1.0lf);
}

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

// For what single precision leaves in doubt. kRoom is some 2^-42 instead of 24 times 2^-53, which
// has room for the rule's own rounding, of the same form. kTouching exceeds the rule's bounds for
// an origin on the triangle, 2^-44, and kTiePart the rays' 2^-43.
const double kRoom = 2.5e-13lf;
const double kTouching = 4e-12lf;
const double kTiePart = 1.2e-13lf;

void test_in_double(uint slot, bool may_pass, dvec3 a, dvec3 b, dvec3 c) {
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
  if ((wanted & kCulls) != 0u && den > 0.0lf) return;
  double det = dot(from, n);
  double t = det / den;
  double across = sum_of_sizes(n);
  double error = 1.5lf * (kRoom * far * s1 * s2 + abs(t) * den_room) / size + 1e-12lf * abs(t) +
                 kTiePart * tie_reach * across / size;
  float middle = float(t - shift);
  float room_t = 1e-6 * abs(middle) + float(error) * 1.001 + 1e-30;
  if (middle + room_t < behind || middle - room_t > nearest_high) return;
  bool is_inside = lowest > room || highest < -room;
  if (!may_pass && is_inside && t > 0.0lf && abs(det) > kTouching * far * across) {
    take(slot, middle - room_t, middle + room_t);
  } else {
    other_low = min(other_low, middle - room_t);
  }
}

// Single precision: docs/internals/ray-casting.md derives the bounds, with one cluster for all
// triangles. Divisions here may be wrong by 2.5 roundings instead of half of one. The bounds of
// distances hold surfaces that tie.
void test_triangle(uint slot) {
  vec4 first = corners[3u * slot];
  vec4 second = corners[3u * slot + 1u];
  vec3 a = first.xyz;
  vec3 b = second.xyz;
  vec3 c = corners[3u * slot + 2u].xyz;
  uint mark = floatBitsToUint(second.w);  // the material's slot; bit 8: equals an earlier triangle
  bool may_pass = (mesh.z >> min(mark & 255u, 31u) & 1u) != 0u;
  if (mark > 255u && mesh.z == 0u && (wanted & kCulls) == 0u) return;
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
  if (is_known && (wanted & kCulls) != 0u && den > 0.0) return;
  bool is_inside = lowest > room || highest < -room;
  if (!may_pass && is_known && is_inside && t - error > ahead) {
    take(slot, t - error, t + error);
  } else {
    test_in_double(slot, may_pass, dvec3(a), dvec3(b), dvec3(c));
  }
}

// Slabs have two roundings and a division, which may be wrong by 2.5 more.
const float kSlabRoom = 1.0 + 4e-6;
const float kEntryRoom = 1.0 - 4e-6;
const uint kLeafBit = 0x80000000u;

// What is left to visit: children, and where the ray enters them in the upper 16 bits of a float,
// two per word. Small, since the memory that threads share decides how many of them run at once.
shared uint children[STACK * GROUP];
shared uint entries[STACK / 2u * GROUP];
uint count = 0u;
uint base = 0u;  // what is below belongs to the tree over the instances
uint next = kNone;  // child to be visited
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
  while (next == kNone && count > base) {
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

vec4 node_row(uint row, bool is_in_tree) { return is_in_tree ? tree_nodes[row] : nodes[row]; }

void enter_four(uint node, bool is_in_tree) {
  vec4 near_x = (node_row(node + near_rows.x, is_in_tree) - near_origin.x) * inverse.x;
  vec4 near_y = (node_row(node + near_rows.y, is_in_tree) - near_origin.y) * inverse.y;
  vec4 near_z = (node_row(node + near_rows.z, is_in_tree) - near_origin.z) * inverse.z;
  vec4 far_x = (node_row(node + far_rows.x, is_in_tree) - far_origin.x) * inverse.x;
  vec4 far_y = (node_row(node + far_rows.y, is_in_tree) - far_origin.y) * inverse.y;
  vec4 far_z = (node_row(node + far_rows.z, is_in_tree) - far_origin.z) * inverse.z;
  uvec4 child = floatBitsToUint(node_row(node + 12u, is_in_tree));
  vec4 first = max(max(near_x, near_y), max(near_z, vec4(0.0)));
  vec4 last = min(min(far_x, far_y), min(far_z, vec4(nearest_high)));
  enter(child.x, first.x, last.x);
  enter(child.y, first.y, last.y);
  enter(child.z, first.z, last.z);
  enter(child.w, first.w, last.w);
}

// Visits the frames of a range one after the other, or those that the tree over the instances
// finds. Loops of their own for frames, nodes and triangles let the threads of a group, and the
// lanes of a vector of the processor, do the same work at a time (T. Aila and S. Laine,
// "Understanding the Efficiency of Ray Traversal on GPUs", 2009).
void trace(uint first, uint end, uint tree) {
  bool is_in_tree = tree != kNone;
  uint entered = is_in_tree ? tree : first < end ? first++ : kNone;
  bool is_new = true;  // the frame is entered at its root
  while (entered != kNone) {
    enter_frame(entered);
    entered = kNone;
    if (is_new) next = mesh.x;
    for (;;) {
      pop();
      while (next < kLeafBit) {
        uint visited = next;
        next = kNone;
        enter_four(16u * visited, is_in_tree);
        enter_four(16u * visited + 1u, is_in_tree);
        pop();
      }
      if (next == kNone || is_in_tree) break;
      uint slot = next & 0x1ffffffu;
      uint last = slot + (next >> 25 & 63u);
      for (; slot <= last; ++slot) test_triangle(slot);
      next = kNone;
      if (other_low <= -kFar) break;
    }
    leave_frame();
    if (others_low <= -kFar_m) break;  // it is undecided
    if (is_in_tree && next != kNone) {
      entered = first + (next & ~kLeafBit);
      next = kNone;
      is_in_tree = false;
      is_new = true;
      base = count;
    } else if (!is_in_tree) {
      is_new = tree == kNone;
      is_in_tree = !is_new;
      entered = is_in_tree ? tree : first < end ? first++ : kNone;
      base = 0u;
    }
  }
}

dvec3 beam_vector(uint index) {
  return dvec3(beams[3u * index], beams[3u * index + 1u], beams[3u * index + 2u]);
}

// Writes the range as Resolver measures it; false where it asks the rule.
bool write_range(uint place, uint primitive) {
  place_ray(best_frame);
  dvec4 plane = planes[frames[best_frame].mesh.y + primitive];
  double cosine = ordered_dot(plane.xyz, direction);
  double distance = distance_to(plane, origin, cosine);
  ranges[place] = range_along(distance, metres_per_unit);
  return abs(cosine) > 1e-6lf && distance > 0.0lf;
}

void main() {
  uint in_tile = gl_LocalInvocationIndex;
  uint tile = first_tile + gl_WorkGroupID.x;
  uint tiles = (grid.x + (1u << grid.z) - 1u) >> grid.z;  // per row
  uint col = (tile % tiles << grid.z) + (in_tile & ((1u << grid.z) - 1u));
  uint row = tile / tiles * (GROUP >> grid.z) + (in_tile >> grid.z);
  if (col >= grid.x || row >= grid.y) return;
  uint beam = row * grid.x + col;
  uint all = grid.x * grid.y;
  beam_direction = beam_vector(beam);
  if ((wanted & kOrigins) != 0u) beam_origin = beam_vector(all + beam);
  View view = views[gl_WorkGroupID.z];
  uvec2 target = uvec2(0u, view.end_frame - view.first_frame);
  if ((wanted & kTargets) != 0u) target = targets[beam];
  if (beam_direction != dvec3(0.0)) {  // else it hits nothing
    trace(view.first_frame + target.x, view.first_frame + target.y, view.tree_frame);
  }
  uint place = gl_WorkGroupID.z * all + beam;
  uint primitive = kNone;
  uint instance = kNone;
  bool is_decided = others_low > best_high || (best_slot == kNone && others_low >= kFar_m);
  if (is_decided && best_slot != kNone) {
    primitive = floatBitsToUint(corners[3u * best_slot].w);
    instance = frames[best_frame].mesh.w;
    if ((wanted & kRanges) != 0u) is_decided = write_range(place, primitive);
  }
  if (!is_decided) primitive = kUndecided;
  if ((wanted & kInstances) != 0u) {
    ids[2u * place] = primitive;
    ids[2u * place + 1u] = instance;
  } else {
    ids[place] = primitive;
  }
}
