// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/kernel.hpp>
#include <glidar/render/rays/ties.hpp>

#include <cstddef>

namespace glidar::rays {

/// Finds the first hits of the beams of one cast by the hit rule: the smallest distance, and among
/// ties the lowest instance and triangle (see lowest_of_ties()). The result does not depend on how
/// beams are grouped.
class BeamSearch {
 public:
  /// References in the view must outlive the search. The trees and the resolver have the cast's
  /// poses.
  BeamSearch(const CastView& cast, const Kernel& kernel) : cast_(cast), kernel_(kernel) {}

  /// Finds what the lanes of block.mask hit, beams block.beam, and sets their instance and
  /// primitive; clears the bits of those that hit nothing.
  void find(const BeamBlock& beams, HitBlock& block) const;

  /// The first hit of one beam; instance kInvalidId: none.
  [[nodiscard]] PrimitiveRef find(std::size_t beam) const;

 private:
  CastView cast_;
  const Kernel& kernel_;
};

}  // namespace glidar::rays
