// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/exact_test.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace glidar::rays {
namespace {

const HitRay& rule_of(RayPacket& packet, unsigned lane) {
  if ((packet.prepared >> lane & 1U) == 0) {
    packet.prepared |= 1U << lane;
    const auto& o = packet.exact_origin;
    const auto& d = packet.exact_direction;
    packet.rule[lane] =
        make_hit_ray({o[0][lane], o[1][lane], o[2][lane]}, {d[0][lane], d[1][lane], d[2][lane]});
  }
  return packet.rule[lane];
}

double distance_to(const TriangleBlock* blocks, RayPacket& packet, unsigned lane,
                   std::uint32_t slot) {
  ++packet.exact_tests;
  return hit_distance(rule_of(packet, lane), triangle_at(blocks, slot));
}

/// The rule's distance to the nearest triangle so far, which the filter had accepted.
void complete_distance(const TriangleBlock* blocks, RayPacket& packet, unsigned lane) {
  if ((packet.known >> lane & 1U) != 0) return;
  packet.distance[lane] = distance_to(blocks, packet, lane, packet.slot[lane]);
  packet.known |= 1U << lane;
  assert(packet.distance[lane] > 0.0 && "the filter was sure of a hit that the rule refuses");
  assert(static_cast<double>(packet.low[lane]) <= packet.distance[lane] - packet.shift[lane] &&
         packet.distance[lane] - packet.shift[lane] <= static_cast<double>(packet.high[lane]) &&
         "the rule's distance is outside the filter's bounds");
}

std::uint32_t primitive_at(const TriangleBlock* blocks, std::uint32_t slot) {
  return blocks[slot / kBlockSize].primitive[slot % kBlockSize];
}

using Vector = std::array<double, 3>;

Vector edge(const std::array<float, 3>& from, const std::array<float, 3>& to) {
  return {double{to[0]} - double{from[0]}, double{to[1]} - double{from[1]},
          double{to[2]} - double{from[2]}};
}

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Distance by which a triangle may be farther and still tie with this one.
double tie_margin(const RayPacket& packet, unsigned lane, const HitTriangle& triangle) {
  if (packet.tie_reach == 0.0) return 0.0;
  const auto& d = packet.exact_direction;
  return tie_window(packet.tie_reach, triangle, {d[0][lane], d[1][lane], d[2][lane]});
}

bool accepts(const RayPacket& packet, unsigned lane, std::uint32_t primitive) {
  return packet.accepts_hit == nullptr || packet.accepts_hit(packet.context, lane, primitive);
}

/// True where the triangle has the same corners as the ray's nearest one, in any order: by the
/// rule, their distances are equal, so the lower one that blocks the ray is kept.
bool keep_lower_duplicate(const TriangleBlock* blocks, RayPacket& packet, unsigned lane,
                          std::uint32_t slot) {
  const std::uint32_t before = packet.slot[lane];
  if (before == kNoTriangle || !have_same_corners(blocks, before, slot)) return false;
  const std::uint32_t primitive = primitive_at(blocks, slot);
  if (primitive < primitive_at(blocks, before) && accepts(packet, lane, primitive)) {
    packet.slot[lane] = slot;
  }
  return true;
}

}  // namespace

bool have_same_corners(const TriangleBlock* blocks, std::uint32_t slot, std::uint32_t other) {
  const HitTriangle a = triangle_at(blocks, slot);
  const HitTriangle b = triangle_at(blocks, other);
  if (a.a != b.a && a.a != b.b && a.a != b.c) return false;
  const std::array<std::array<float, 3>, 3> first = {a.a, a.b, a.c};
  const std::array<std::array<float, 3>, 3> second = {b.a, b.b, b.c};
  return std::is_permutation(first.begin(), first.end(), second.begin());
}

double tie_window(double reach, const HitTriangle& triangle, const Vector& direction) {
  const Vector p = edge(triangle.a, triangle.b);
  const Vector q = edge(triangle.a, triangle.c);
  const Vector n = {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2],
                    p[0] * q[1] - p[1] * q[0]};
  const double along = std::abs(dot(n, direction));
  const double across = along > 0.0 ? std::sqrt(dot(n, n)) / along : 1.0;  // 1: without area
  return kTiePart * reach * across;
}

bool may_tie(double apart, double window, bool replaces) {
  return apart == 0.0 ? replaces : !(std::abs(apart) > window);
}

void retest_exactly(const TriangleBlock* blocks, RayPacket& packet, unsigned lane,
                    std::uint32_t slot) {
  if (keep_lower_duplicate(blocks, packet, lane, slot)) return;
  const double distance = distance_to(blocks, packet, lane, slot);
  if (distance == 0.0) return;
  const std::uint32_t primitive = primitive_at(blocks, slot);
  if (!accepts(packet, lane, primitive)) return;
  const double tie = tie_margin(packet, lane, triangle_at(blocks, slot));
  if (packet.slot[lane] != kNoTriangle) {
    complete_distance(blocks, packet, lane);
    const HitCandidate nearest{packet.distance[lane], 0, primitive_at(blocks, packet.slot[lane])};
    const bool replaces = is_nearer({distance, 0, primitive}, nearest);
    const HitTriangle before = triangle_at(blocks, packet.slot[lane]);
    const double window = std::max(tie, tie_margin(packet, lane, before));
    if (may_tie(distance - nearest.distance, window, replaces)) packet.tied |= 1U << lane;
    if (!replaces) return;
  }
  packet.slot[lane] = slot;
  packet.distance[lane] = distance;
  packet.known |= 1U << lane;
  const auto rounded = static_cast<float>(distance - packet.shift[lane]);
  const float margin = 0x1p-22F * std::abs(rounded) + 0x1p-120F + static_cast<float>(1.01 * tie);
  packet.low[lane] = rounded - margin;
  packet.high[lane] = rounded + margin;
}

void complete_distances(const TriangleBlock* blocks, RayPacket& packet) {
  for (unsigned lane = 0; lane < kPacketSize; ++lane) {
    const bool is_active = (packet.active >> lane & 1U) != 0;
    if (is_active && packet.slot[lane] != kNoTriangle) complete_distance(blocks, packet, lane);
  }
}

}  // namespace glidar::rays
