// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/instance_tree.hpp>
#include <glidar/render/judgement.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/render/triangle_tree.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar {

/// The exact test, in double, over all triangles that a beam may meet: what renderers ask for the
/// few beams that single precision leaves in doubt. Of surfaces that coincide where a beam meets
/// them (see slack()) it returns the lowest (instance, triangle).
class ExactSearch {
 public:
  /// The resolver must outlive the search.
  explicit ExactSearch(const Resolver& resolver)
      : resolver_(resolver), trees_(resolver.scene()), boxes_(resolver.scene().meshes.size()) {}

  /// Takes the instances of the next cast, which must outlive its queries; the resolver has its
  /// poses.
  void prepare(const CastRequest& request);

  /// The first surface that a beam meets; instance kNoHit: none.
  [[nodiscard]] Found nearest(std::size_t beam) const;

  /// True when boxes of instances overlap, so that surfaces of several may coincide.
  [[nodiscard]] bool has_overlaps() const { return instances_.has_overlaps(); }

  /// A bit for every hit lane in whose place another instance has a triangle's box.
  [[nodiscard]] std::uint32_t overlapping(const HitBlock& block, const BeamBlock& beams,
                                          const ExactBlock& exact) const;

  /// What a beam meets first among all surfaces so near the one found that single precision may
  /// have mistaken their order.
  [[nodiscard]] Found nearest_around(std::size_t beam, const Found& found) const;

 private:
  [[nodiscard]] Judgement judgement(std::size_t beam) const;
  [[nodiscard]] double slack_of(std::uint32_t instance, const ObjectRay& ray) const;
  [[nodiscard]] bool stops_beam(const Judgement& judgement, const Found& candidate) const;
  template <class Take>
  void for_triangles_on(Judgement& judgement, std::uint32_t instance, const Take& take) const;
  template <class Take>
  void for_triangles_ahead(Judgement& judgement, const Take& take) const;
  template <class Take>
  void for_triangles_at(Judgement& judgement, std::uint32_t instance, double range_m,
                        const Take& take) const;
  template <class Take>
  void for_triangles_around(Judgement& judgement, const Found& found, double range_m,
                            const Take& take) const;
  [[nodiscard]] ObjectRay ray_in_tree(std::size_t beam) const;
  [[nodiscard]] std::uint32_t lanes_at(std::uint32_t instance, std::uint32_t lanes,
                                       const Eigen::AlignedBox3d& around,
                                       const Lanes3<double>& in_tree) const;

  const Resolver& resolver_;
  TriangleTrees trees_;
  std::vector<Eigen::AlignedBox3d> boxes_;  ///< per mesh, relative to its origin
  bool has_boxes_ = false;
  const CastRequest* request_ = nullptr;
  InstanceTree instances_;
};

}  // namespace glidar
