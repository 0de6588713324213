// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/grid_window.hpp>
#include <glidar/render/rays/beam_search.hpp>
#include <glidar/render/rays/scene_trees.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/render/resolver.hpp>
#include <glidar/render/triangle_ids.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace glidar {

/// A tree of bounding boxes over the instances of one cast, eight boxes to a node. It finds the
/// instances near a point without a test of each.
///
/// The tree has its own frame, in metres: the sensor's origin and the axes of the largest instance.
/// Boxes of objects that are aligned with it therefore stay small.
class InstanceTree {
 public:
  using Box = Eigen::AlignedBox3d;

  /// Builds the tree over the enabled instances. The resolver has the cast's poses; `mesh_boxes`
  /// are relative to the origins of the meshes. Boxes are grown by the rounding of single
  /// precision.
  void build(const CastRequest& request, const Resolver& resolver, std::span<const Box> mesh_boxes);

  [[nodiscard]] const Eigen::Matrix3d& tree_from_sensor() const { return tree_from_sensor_; }

  /// True when boxes of instances overlap.
  [[nodiscard]] bool has_overlaps() const { return has_overlaps_; }

  /// The part of an instance's box that the boxes of others overlap; empty: none does.
  [[nodiscard]] const Box& shared(std::uint32_t instance) const { return shared_[instance]; }

  /// Calls visit(instance) for every instance whose box intersects this one, until it returns
  /// false.
  template <class Visit>
  void visit_near(const Box& box, const Visit& visit) const {
    if (!order_.empty()) visit_node(level_count_ - 1, 0, box, visit);
  }

 private:
  static constexpr std::size_t kFan = 8;
  static constexpr std::size_t kMaxLevels = 12;  // for 2^32 instances

  void sort_instances();
  void build_nodes();
  void find_shared();

  /// False when visit() has ended the search.
  template <class Visit>
  bool visit_node(std::size_t level, std::size_t index, const Box& box, const Visit& visit) const {
    if (!nodes_[level_begin_[level] + index].intersects(box)) return true;
    if (level == 0) return visit(order_[index].second);
    const std::size_t below = level_begin_[level] - level_begin_[level - 1];
    const std::size_t end = std::min(below, (index + 1) * kFan);
    for (std::size_t i = index * kFan; i < end; ++i) {
      if (!visit_node(level - 1, i, box, visit)) return false;
    }
    return true;
  }

  Eigen::Matrix3d tree_from_sensor_ = Eigen::Matrix3d::Identity();
  bool has_overlaps_ = false;
  std::vector<Box> boxes_;   ///< per instance; empty: not enabled
  std::vector<Box> shared_;  ///< per instance
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order_;  ///< Morton code, instance
  std::vector<Box> nodes_;                                      ///< level by level from the leaves
  std::array<std::size_t, kMaxLevels> level_begin_ = {};
  std::size_t level_count_ = 0;
};

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

/// Inputs for converting a visibility buffer (triangle ids per pixel), or a tile of one, into hits.
struct HitWriter {
  const CastRequest& request;
  const Resolver& resolver;
  const TriangleIds& triangles;
  const PlanePoints& points;
  PixelRect drawn;                              ///< the pixels that triangle_ids contains
  std::span<const std::uint32_t> triangle_ids;  ///< of `drawn`, row by row
  PixelRect written;                            ///< those of `drawn` whose hits are written
  Hits& hits;
  const rays::BeamSearch& search;  ///< casts uncertain beams
  const Overlaps& overlaps;
};

/// Tight near and far planes around all enabled instances; the resolver has the cast's poses. One
/// box per mesh, relative to its origin.
DepthRange depths_of(const CastRequest& request, const Resolver& resolver,
                     std::span<const Eigen::AlignedBox3d> mesh_boxes);

/// Writes the hits of rows [begin, end) of `written` and reports them to the request.
void write_rows(const HitWriter& writer, std::uint32_t begin, std::uint32_t end);

}  // namespace glidar
