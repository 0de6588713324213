// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/ties.hpp>

#include <glidar/render/rays/exact_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace glidar::rays {
namespace {

/// A ray up to a maximum distance, in the frame of a tree.
struct Segment {
  ObjectRay ray;
  double margin;  ///< boxes are grown by it
  double end;
};

/// By slabs: T. L. Kay and J. T. Kajiya, "Ray tracing complex scenes" (1986).
bool meets(const TreeNode& node, unsigned child, const Segment& segment) {
  double enter = 0.0;
  double leave = segment.end;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = double{node.low[axis][child]} - segment.margin - segment.ray.origin[axis];
    const double high = double{node.high[axis][child]} + segment.margin - segment.ray.origin[axis];
    const double d = segment.ray.direction[axis];
    if (d == 0.0) {
      if (low > 0.0 || high < 0.0) return false;
      continue;
    }
    enter = std::max(enter, std::min(low / d, high / d));
    leave = std::min(leave, std::max(low / d, high / d));
  }
  return enter <= leave + segment.margin;
}

/// Calls visit(leaf) for all leaves that the segment meets.
template <class Visit>
void for_leaves_on(const TreeNode* nodes, std::uint32_t index, const Segment& segment,
                   const Visit& visit) {
  const TreeNode& node = nodes[index];
  for (unsigned i = 0; i < 8; ++i) {
    const std::int32_t child = node.child[i];
    if (child == kNoChild || !meets(node, i, segment)) continue;
    if (child < 0) {
      visit(static_cast<std::uint32_t>(~child));
    } else {
      for_leaves_on(nodes, static_cast<std::uint32_t>(child), segment, visit);
    }
  }
}

/// Finds the triangles of a scene that a beam hits about as near as a given one.
class Candidates {
 public:
  Candidates(const CastView& cast, std::size_t beam, const PrimitiveRef& nearest)
      : cast_(cast),
        beam_(beam),
        nearest_(nearest),
        nearest_m_(hit_distance_m(cast, beam, nearest)) {}

  /// Calls visit(triangle, distance in metres) for every triangle that blocks the beam and may tie
  /// with the given one.
  template <class Visit>
  void visit_all(const Visit& visit) const {
    if (!cast_.request.targets.empty()) {
      const InstanceRange& target = cast_.request.targets[beam_];
      const double end_m = end_within(max_reach_m(cast_, target));
      for (std::uint32_t i = target.begin; i < target.end; ++i) visit_instance(i, end_m, visit);
      return;
    }
    for (const InstanceGroup& group : cast_.trees.groups()) {
      const double end_m = end_within(group.reach_m);
      if (cast_.trees.instances().size() == 1) {
        return visit_instance(group.instances[0], end_m, visit);
      }
      const Segment segment{ray_in_tree(), kTieMargin * group.reach_m, end_m};
      for_leaves_on(group.boxes.nodes().data(), 0, segment, [&](std::uint32_t leaf) {
        visit_instance(group.boxes.index_in(leaf), end_m, visit);
      });
    }
  }

  [[nodiscard]] double nearest_m() const { return nearest_m_; }

 private:
  static constexpr double kTieMargin = 0x1p-40;  // many roundings of a coordinate

  /// The maximum distance of a triangle that ties, of an instance up to this reach.
  [[nodiscard]] double end_within(double reach_m) const {
    const double larger_m = std::max(reach_m, cast_.trees.reach_m(nearest_.instance));
    return nearest_m_ + tie_window_m(cast_, beam_, nearest_, larger_m);
  }

  [[nodiscard]] ObjectRay ray_in_tree() const {
    const Beams& beams = cast_.request.beams;
    const Eigen::Matrix3d& rotation = cast_.trees.tree_from_sensor();
    ObjectRay ray{cast_.trees.sensor_in_tree(), rotation * beams.directions[beam_]};
    if (!beams.origins_m.empty()) ray.origin += rotation * beams.origins_m[beam_];
    return ray;
  }

  template <class Visit>
  void visit_instance(std::uint32_t instance, double end_m, const Visit& visit) const {
    const InstanceView& view = cast_.resolver.view(instance);
    const MeshTree& tree = cast_.trees.of_instance(instance);
    if (tree.nodes.empty()) return;
    const ObjectRay ray = ray_in(view, cast_.request.beams, beam_);
    const Segment segment{ray, kTieMargin * cast_.trees.reach_m(instance) / view.scale,
                          end_m / view.scale};
    const HitRay rule = make_hit_ray(ray.origin, ray.direction);
    for_leaves_on(tree.nodes.data(), 0, segment, [&](std::uint32_t leaf) {
      const TriangleCluster& cluster = tree.clusters[leaf];
      const std::uint32_t first = cluster.first_block * kBlockSize;
      for (std::uint32_t slot = first; slot < first + cluster.count; ++slot) {
        const double distance = hit_distance(rule, triangle_at(tree.blocks.data(), slot));
        if (distance == 0.0) continue;
        const PrimitiveRef found{instance,
                                 tree.blocks[slot / kBlockSize].primitive[slot % kBlockSize]};
        if (blocks(found)) visit(found, distance * view.scale);
      }
    });
  }

  [[nodiscard]] bool blocks(const PrimitiveRef& found) const {
    return blocks_beam(cast_.resolver, cast_.request.beams, beam_, cast_.request.cull_back_faces,
                       found);
  }

  const CastView& cast_;
  std::size_t beam_;
  PrimitiveRef nearest_;
  double nearest_m_;
};

}  // namespace

double max_reach_m(const CastView& cast, const InstanceRange& instances) {
  double reach_m = 0.0;
  for (std::uint32_t i = instances.begin; i < instances.end; ++i) {
    reach_m = std::max(reach_m, cast.trees.reach_m(i));
  }
  return reach_m;
}

double hit_distance_m(const CastView& cast, std::size_t beam, const PrimitiveRef& triangle) {
  const InstanceView& view = cast.resolver.view(triangle.instance);
  const ObjectRay ray = ray_in(view, cast.request.beams, beam);
  const HitTriangle corners = corners_of(cast.resolver.mesh(triangle.instance), triangle.primitive);
  return view.scale * hit_distance(make_hit_ray(ray.origin, ray.direction), corners);
}

double tie_window_m(const CastView& cast, std::size_t beam, const PrimitiveRef& triangle,
                    double reach_m) {
  const ObjectRay ray = ray_in(cast.resolver.view(triangle.instance), cast.request.beams, beam);
  const HitTriangle corners = corners_of(cast.resolver.mesh(triangle.instance), triangle.primitive);
  return tie_window(reach_m, corners, {ray.direction.x(), ray.direction.y(), ray.direction.z()});
}

HitOrder order_of_hits(const CastView& cast, std::size_t beam, const PrimitiveRef& found,
                       const PrimitiveRef& before, double reach_m) {
  const double before_m = hit_distance_m(cast, beam, before);
  const double found_m = hit_distance_m(cast, beam, found);
  const bool is_nearer = glidar::is_nearer({found_m, found.instance, found.primitive},
                                           {before_m, before.instance, before.primitive});
  const double window_m =
      std::max(tie_window_m(cast, beam, found, reach_m), tie_window_m(cast, beam, before, reach_m));
  return {.is_nearer = is_nearer, .ties = may_tie(found_m - before_m, window_m, is_nearer)};
}

PrimitiveRef lowest_of_ties(const CastView& cast, std::size_t beam, const PrimitiveRef& nearest) {
  const double reach_m = cast.trees.reach_m(nearest.instance);
  const Candidates candidates(cast, beam, nearest);
  PrimitiveRef lowest = nearest;
  candidates.visit_all([&](const PrimitiveRef& found, double distance_m) {
    if (!is_lower(found, lowest)) return;
    const double both_m = 0.5 * (reach_m + cast.trees.reach_m(found.instance));
    const double window_m = std::min(tie_window_m(cast, beam, found, both_m),
                                     tie_window_m(cast, beam, nearest, both_m));
    if (distance_m - candidates.nearest_m() <= window_m) lowest = found;
  });
  return lowest;
}

}  // namespace glidar::rays
