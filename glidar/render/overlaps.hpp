// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/instance_tree.hpp>
#include <glidar/render/rays/scene_trees.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

/// Finds hits where another instance has a triangle too: a rasterizer cannot decide which of two
/// surfaces is nearer when the gap between them is below its resolution.
class Overlaps {
 public:
  /// Both must outlive this.
  Overlaps(const Resolver& resolver, const rays::SceneTrees& trees);

  /// Prepares the next cast; the resolver and the trees have its poses.
  void prepare(const CastRequest& request);

  /// True when boxes of instances overlap.
  [[nodiscard]] bool has_any() const { return instances_.has_overlaps(); }

  /// A bit for every hit lane whose point is in the box of another instance's triangle.
  [[nodiscard]] std::uint32_t lanes_near(const HitBlock& block, const BeamBlock& beams,
                                         const ExactHits& exact) const;

 private:
  [[nodiscard]] std::uint32_t lanes_at(std::uint32_t instance, std::uint32_t lanes,
                                       const Eigen::AlignedBox3d& around,
                                       const Lanes3<double>& in_tree) const;

  const Resolver& resolver_;
  const rays::SceneTrees& trees_;
  std::vector<Eigen::AlignedBox3d> boxes_;  ///< per mesh, relative to its origin
  InstanceTree instances_;
};

}  // namespace glidar
