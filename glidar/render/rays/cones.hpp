// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/ray_packet.hpp>

#include <cstdint>

namespace glidar::rays {

/// A triangle that rays of a cone may hit.
struct ConeHit {
  float low;  ///< lower bound of the distance, as in RayPacket
  std::uint32_t cluster;
  std::uint32_t slot;
  bool is_certain;  ///< all rays of the cone hit it, before the cone's end
};

/// More make a cone overflow.
inline constexpr unsigned kMaxConeHits = 12;

/// Sixteen cones around the rays of a packet, one per lane: bundles of rays, each with nearly the
/// direction and the origin of its lane's ray. Plain arrays, as in RayPacket. A cone ends at
/// RayPacket::high of its lane: its hits are all triangles that rays of it may hit before.
struct Cones {
  // Set before Kernel::trace_cones().
  float slope;    ///< upper bound of |direction - lane's direction|, at most kMaxSlope
  float radius;   ///< upper bound of |origin - lane's origin|
  bool may_pass;  ///< triangles may let rays pass: no hit is certain
  // Results, added to those that are there.
  std::uint32_t overflowed;  ///< bit i: cone i met too many triangles
  std::uint32_t count[kPacketSize];
  ConeHit hit[kPacketSize][kMaxConeHits];
};

/// Error bounds of the filter have room for slopes up to it.
inline constexpr float kMaxSlope = 0.1F;

}  // namespace glidar::rays
