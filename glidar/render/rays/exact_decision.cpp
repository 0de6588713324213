// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/exact_decision.hpp>

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
  ++packet.decisions;
  return hit_distance(rule_of(packet, lane), triangle_at(blocks, slot));
}

/// The rule's distance to the nearest triangle so far, which the filter was sure of.
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

}  // namespace

void decide(const TriangleBlock* blocks, RayPacket& packet, unsigned lane, std::uint32_t slot) {
  const double distance = distance_to(blocks, packet, lane, slot);
  if (distance == 0.0) return;
  if (packet.slot[lane] != kNoTriangle) {
    complete_distance(blocks, packet, lane);
    const HitCandidate nearest{packet.distance[lane], 0, primitive_at(blocks, packet.slot[lane])};
    if (!is_nearer({distance, 0, primitive_at(blocks, slot)}, nearest)) return;
  }
  packet.slot[lane] = slot;
  packet.distance[lane] = distance;
  packet.known |= 1U << lane;
  const auto rounded = static_cast<float>(distance - packet.shift[lane]);
  const float room = 0x1p-22F * std::abs(rounded) + 0x1p-120F;
  packet.low[lane] = rounded - room;
  packet.high[lane] = rounded + room;
}

void complete_distances(const TriangleBlock* blocks, RayPacket& packet) {
  for (unsigned lane = 0; lane < kPacketSize; ++lane) {
    const bool is_active = (packet.active >> lane & 1U) != 0;
    if (is_active && packet.slot[lane] != kNoTriangle) complete_distance(blocks, packet, lane);
  }
}

}  // namespace glidar::rays
