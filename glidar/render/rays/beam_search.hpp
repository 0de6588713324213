// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/kernel.hpp>
#include <glidar/render/rays/ties.hpp>

#include <cstddef>
#include <span>

namespace glidar::rays {

/// A leaf of an instance's tree.
struct LeafRef {
  std::uint32_t instance;
  std::uint32_t cluster;

  auto operator<=>(const LeafRef&) const = default;
};

/// Sets the exact rays of a packet: the beams in an instance's frame.
void set_rays(const InstanceView& view, const BeamBlock& beams, RayPacket& packet);

/// The view of the trees' frame, treated as that of an instance.
InstanceView tree_view(const SceneTrees& trees);

/// An upper bound of a distance in a ray's packet: after its shift.
float bound_in(const RayPacket& packet, unsigned lane, double distance);

/// Finds the first hits of the beams of one cast by the hit rule: the smallest distance, and among
/// ties the lowest instance and triangle (see lowest_of_ties()). The result does not depend on how
/// beams are grouped.
class BeamSearch {
 public:
  /// References in the view must outlive the search. The trees and the resolver have the cast's
  /// poses.
  BeamSearch(const CastView& cast, const Kernel& kernel) : cast_(cast), kernel_(kernel) {}

  [[nodiscard]] const CastView& cast() const { return cast_; }
  [[nodiscard]] const Kernel& kernel() const { return kernel_; }

  /// Finds what the lanes of block.mask hit, beams block.beam, and sets their instance and
  /// primitive; clears the bits of those that hit nothing.
  void find(const BeamBlock& beams, HitBlock& block) const;

  /// The same for usable beams, among the triangles of some leaves, sorted. All that a lane may
  /// hit up to `end_m` is in them. Returns the lanes that this decides, and sets only these.
  [[nodiscard]] std::uint32_t find_among(std::span<const LeafRef> leaves,
                                         const Lanes<double>& end_m, const BeamBlock& beams,
                                         HitBlock& block) const;

  /// The first hit of one beam; instance kInvalidId: none.
  [[nodiscard]] PrimitiveRef find(std::size_t beam) const;

 private:
  CastView cast_;
  const Kernel& kernel_;
};

}  // namespace glidar::rays
