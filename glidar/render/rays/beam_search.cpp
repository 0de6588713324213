// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/beam_search.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/render/common/rounding.hpp>
#include <glidar/render/rays/exact_test.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace glidar::rays {
namespace {

static_assert(kLanes == kPacketSize);

/// Per lane, bits of which some are set unless the direction is finite and the origin within range.
GLIDAR_SIMD void find_defects(const BeamBlock& beams, Lanes<std::uint64_t>& defects) {
  const Lanes3<double>& d = beams.direction;
  const Lanes3<double>& o = beams.origin_m;
  for (unsigned i = 0; i < kLanes; ++i) {
    const double sum = d.x[i] + d.y[i] + d.z[i];
    defects[i] = std::bit_cast<std::uint64_t>(sum - sum);
  }
  if (!beams.has_origins) return;
  for (unsigned i = 0; i < kLanes; ++i) {
    const double size = std::abs(o.x[i]) + std::abs(o.y[i]) + std::abs(o.z[i]);
    defects[i] |= static_cast<std::uint64_t>(!(size <= 3.0 * kMaxCoordinate_m));
  }
}

/// Lanes with finite directions and with origins within range.
std::uint32_t usable_lanes(const BeamBlock& beams) {
  Lanes<std::uint64_t> defects;
  find_defects(beams, defects);
  std::uint32_t lanes = 0;
  for (unsigned i = 0; i < kLanes; ++i) lanes |= static_cast<std::uint32_t>(defects[i] == 0) << i;
  return lanes;
}

/// Data for the filter of a triangle's hits, see RayPacket::accepts_hit.
struct HitFilterContext {
  const CastView& cast;
  const HitBlock& block;
  std::uint32_t instance;

  static bool accepts(const void* context, unsigned lane, std::uint32_t primitive) {
    const auto& self = *static_cast<const HitFilterContext*>(context);
    return glidar::blocks_beam(self.cast.resolver, self.cast.request.beams, self.block.beam[lane],
                               self.cast.request.cull_back_faces, {self.instance, primitive});
  }
};

/// Casts up to sixteen beams through one instance.
class InstanceTrace {
 public:
  InstanceTrace(const CastView& cast, const Kernel& kernel, const HitBlock& block)
      : cast_(cast), kernel_(kernel), hit_filter_{cast, block, 0} {}

  RayPacket packet;

  /// Sets the rays of these lanes, at least one. `reach_m`: of the instance's group.
  void start(std::uint32_t instance, double reach_m, const BeamBlock& beams, std::uint32_t lanes) {
    const InstanceView& view = cast_.resolver.view(instance);
    set_rays(view, beams, packet);
    hit_filter_.instance = instance;
    packet.tie_reach = reach_m / view.scale;
    const bool filters_hits = cast_.request.cull_back_faces || cast_.resolver.is_masked(instance);
    packet.accepts_hit = filters_hits ? HitFilterContext::accepts : nullptr;
    packet.context = &hit_filter_;
    kernel_.start(packet, cast_.trees.of_instance(instance).sphere, lanes);
  }

  void trace() { kernel_.trace(tree().view(), packet); }

  /// Tests only the triangles of some leaves.
  void test(std::span<const LeafRef> leaves, std::uint32_t lanes) {
    for (const LeafRef& leaf : leaves) {
      kernel_.test_leaf(tree().view(), leaf.cluster, packet, lanes);
    }
  }

  [[nodiscard]] std::uint32_t primitive(unsigned lane) const {
    return primitive_of(tree().blocks.data(), packet, lane);
  }

 private:
  [[nodiscard]] const MeshTree& tree() const {
    return cast_.trees.of_instance(hit_filter_.instance);
  }

  const CastView& cast_;
  const Kernel& kernel_;
  HitFilterContext hit_filter_;
};

/// The nearest hit of a lane in all instances so far.
struct Nearest {
  PrimitiveRef primitive;
  double low_m = kInfinity;  ///< bounds of the distance
  double high_m = kInfinity;
};

/// Casts up to sixteen beams through several instances.
class SceneTrace {
 public:
  SceneTrace(const CastView& cast, const Kernel& kernel, const BeamBlock& beams,
             const HitBlock& block)
      : cast_(cast), kernel_(kernel), beams_(beams), block_(block), inner_(cast, kernel, block) {}

  /// Casts them through all instances.
  void trace(std::uint32_t lanes) {
    RayPacket packet;
    set_rays(tree_view(cast_.trees), beams_, packet);
    for (const InstanceGroup& group : cast_.trees.groups()) {
      group_ = &group;
      reach_m_ = group.reach_m;
      kernel_.start(packet, group.boxes.sphere(), lanes);
      end_at_nearest(lanes, packet);
      kernel_.visit_leaves(
          group.tree(), packet,
          [](void* self, std::uint32_t leaf, RayPacket& outer, std::uint32_t entering) {
            static_cast<SceneTrace*>(self)->visit_leaf(leaf, outer, entering);
          },
          this);
    }
  }

  /// Casts them through these instances only.
  void trace(const InstanceRange& instances, std::uint32_t lanes) {
    reach_m_ = max_reach_m(cast_, instances);
    for (std::uint32_t i = instances.begin; i < instances.end; ++i) {
      if (!cast_.trees.of_instance(i).nodes.empty()) visit(i, lanes);
    }
  }

  /// Casts them to the triangles of these leaves only, which are sorted.
  void trace(std::span<const LeafRef> leaves, std::uint32_t lanes) {
    reach_m_ = cast_.trees.max_reach_m();
    while (!leaves.empty()) {
      const std::uint32_t instance = leaves.front().instance;
      const auto is_other = [&](const LeafRef& leaf) { return leaf.instance != instance; };
      const auto end = std::find_if(leaves.begin(), leaves.end(), is_other);
      const auto count = static_cast<std::size_t>(end - leaves.begin());
      visit(instance, lanes, leaves.first(count));
      leaves = leaves.subspan(count);
    }
  }

  [[nodiscard]] const PrimitiveRef& found(unsigned lane) const { return nearest_[lane].primitive; }

  /// The lanes whose hits, with all that ties with them, are up to a distance; where that is
  /// infinite, also the lanes without a hit.
  [[nodiscard]] std::uint32_t ending_by(const Lanes<double>& end_m, std::uint32_t lanes) const {
    std::uint32_t ending = 0;
    for_lanes(lanes, [&](unsigned i) {
      ending |= static_cast<std::uint32_t>(nearest_[i].high_m <= end_m[i]) << i;
    });
    return ending;
  }

  /// The lanes for which some distances tie.
  [[nodiscard]] std::uint32_t tied() const { return tied_; }

 private:
  /// Ends rays at their hits in the groups before. The bounds of these now include ties with
  /// instances of this group, which reach farther.
  void end_at_nearest(std::uint32_t lanes, RayPacket& outer) {
    for_lanes(lanes, [&](unsigned i) {
      Nearest& nearest = nearest_[i];
      if (nearest.primitive.instance == kInvalidId) return;
      const double window_m =
          1.01 * tie_window_m(cast_, block_.beam[i], nearest.primitive, reach_m_);
      nearest.low_m -= window_m;
      nearest.high_m += window_m;
      outer.high[i] = bound_in(outer, i, nearest.high_m);
    });
  }

  void visit_leaf(std::uint32_t leaf, RayPacket& outer, std::uint32_t lanes) {
    for_lanes(visit(group_->boxes.index_in(leaf), lanes),
              [&](unsigned i) { outer.high[i] = bound_in(outer, i, nearest_[i].high_m); });
  }

  /// Returns the lanes that hit the instance. `leaves`: of the instance, empty: all.
  std::uint32_t visit(std::uint32_t instance, std::uint32_t lanes,
                      std::span<const LeafRef> leaves = {}) {
    const double scale = cast_.resolver.view(instance).scale;
    RayPacket& p = inner_.packet;
    inner_.start(instance, reach_m_, beams_, lanes);
    for_lanes(lanes, [&](unsigned i) {
      if (nearest_[i].primitive.instance == kInvalidId) return;
      p.high[i] = bound_in(p, i, nearest_[i].high_m / scale);
    });
    if (leaves.empty()) {
      inner_.trace();
    } else {
      inner_.test(leaves, lanes);
    }
    tied_ |= p.tied;
    std::uint32_t hit = 0;
    for_lanes(lanes, [&](unsigned i) {
      if (p.slot[i] == kNoTriangle) return;
      update_nearest(i, {instance, inner_.primitive(i)}, scale);
      hit |= 1U << i;
    });
    return hit;
  }

  /// Keeps the nearer of the lane's hit and that of the inner packet.
  void update_nearest(unsigned lane, const PrimitiveRef& found, double scale) {
    const RayPacket& p = inner_.packet;
    const double margin = 0x1p-50 * p.shift[lane];
    Nearest& nearest = nearest_[lane];
    const Nearest other{found, scale * (p.shift[lane] + double{p.low[lane]} - margin),
                        scale * (p.shift[lane] + double{p.high[lane]} + margin)};
    const bool is_first = nearest.primitive.instance == kInvalidId;
    if (!is_first && other.low_m > nearest.high_m) return;
    if (is_first || other.high_m < nearest.low_m || retest_exactly(lane, found)) nearest = other;
  }

  /// True when the beam hits this triangle before the nearest so far.
  bool retest_exactly(unsigned lane, const PrimitiveRef& found) {
    const HitOrder order =
        order_of_hits(cast_, block_.beam[lane], found, nearest_[lane].primitive, reach_m_);
    if (order.ties) tied_ |= 1U << lane;
    return order.is_nearer;
  }

  const CastView& cast_;
  const Kernel& kernel_;
  const BeamBlock& beams_;
  const HitBlock& block_;
  InstanceTrace inner_;
  const InstanceGroup* group_ = nullptr;  ///< that is being traced
  double reach_m_ = 0.0;                  ///< upper bound of those of the instances so far
  std::array<Nearest, kLanes> nearest_;
  std::uint32_t tied_ = 0;
};

/// Casts up to sixteen beams, and writes what they hit to their block.
class BlockTrace {
 public:
  BlockTrace(const CastView& cast, const Kernel& kernel, const BeamBlock& beams, HitBlock& block)
      : cast_(cast), kernel_(kernel), beams_(beams), block_(block) {}

  void trace_one(std::uint32_t instance, double reach_m, std::uint32_t lanes) {
    InstanceTrace trace(cast_, kernel_, block_);
    trace.start(instance, reach_m, beams_, lanes);
    trace.trace();
    for_lanes(lanes, [&](unsigned i) {
      const std::uint32_t primitive = trace.primitive(i);
      if (primitive != kNoTriangle) set(i, {instance, primitive});
    });
    set_lowest_of_ties(trace.packet.tied);
  }

  void trace_all(std::uint32_t lanes) {
    SceneTrace trace(cast_, kernel_, beams_, block_);
    trace.trace(lanes);
    finish(trace, lanes);
  }

  /// Returns the lanes that are decided by `end_m`, and sets these.
  std::uint32_t trace_leaves(std::span<const LeafRef> leaves, const Lanes<double>& end_m,
                             std::uint32_t lanes) {
    SceneTrace trace(cast_, kernel_, beams_, block_);
    trace.trace(leaves, lanes);
    const std::uint32_t decided = trace.ending_by(end_m, lanes);
    finish(trace, decided);
    return decided;
  }

  /// Casts every lane through its beam's target; lanes with equal targets together.
  void trace_targets(std::uint32_t lanes) {
    while (lanes != 0) {
      const InstanceRange& target = target_of(static_cast<unsigned>(std::countr_zero(lanes)));
      std::uint32_t alike = 0;
      for_lanes(lanes, [&](unsigned i) {
        alike |= static_cast<std::uint32_t>(target_of(i) == target) << i;
      });
      SceneTrace trace(cast_, kernel_, beams_, block_);
      trace.trace(target, alike);
      finish(trace, alike);
      lanes &= ~alike;
    }
  }

 private:
  [[nodiscard]] const InstanceRange& target_of(unsigned lane) const {
    return cast_.request.targets[block_.beam[lane]];
  }

  void finish(const SceneTrace& trace, std::uint32_t lanes) {
    for_lanes(lanes, [&](unsigned i) { set(i, trace.found(i)); });
    set_lowest_of_ties(trace.tied());
  }

  void set_lowest_of_ties(std::uint32_t tied) {
    for_lanes(tied & block_.mask, [&](unsigned i) {
      set(i, lowest_of_ties(cast_, block_.beam[i], {block_.instance[i], block_.primitive[i]}));
    });
  }

  void set(unsigned lane, const PrimitiveRef& found) {
    if (found.instance == kInvalidId) return;
    block_.mask |= 1U << lane;
    block_.instance[lane] = found.instance;
    block_.primitive[lane] = found.primitive;
  }

  const CastView& cast_;
  const Kernel& kernel_;
  const BeamBlock& beams_;
  HitBlock& block_;
};

}  // namespace

void set_rays(const InstanceView& view, const BeamBlock& beams, RayPacket& packet) {
  Lanes3<double> origin;
  Lanes3<double> direction;
  rays_in(view, beams, origin, direction);
  static_assert(sizeof(packet.exact_origin) == sizeof(origin));
  std::memcpy(packet.exact_origin, &origin, sizeof(origin));
  std::memcpy(packet.exact_direction, &direction, sizeof(direction));
}

InstanceView tree_view(const SceneTrees& trees) {
  return {trees.tree_from_sensor(), trees.sensor_in_tree(), 1.0};
}

float bound_in(const RayPacket& packet, unsigned lane, double distance) {
  return well_above(distance - packet.shift[lane] + 0x1p-50 * distance);
}

void BeamSearch::find(const BeamBlock& beams, HitBlock& block) const {
  const std::uint32_t lanes = block.mask & usable_lanes(beams);
  block.mask = 0;
  if (lanes == 0) return;
  BlockTrace trace(cast_, kernel_, beams, block);
  const std::vector<std::uint32_t>& instances = cast_.trees.instances();
  if (!cast_.request.targets.empty()) {
    trace.trace_targets(lanes);
  } else if (instances.size() == 1) {
    trace.trace_one(instances[0], cast_.trees.max_reach_m(), lanes);
  } else if (!instances.empty()) {
    trace.trace_all(lanes);
  }
}

std::uint32_t BeamSearch::find_among(std::span<const LeafRef> leaves, const Lanes<double>& end_m,
                                     const BeamBlock& beams, HitBlock& block) const {
  const std::uint32_t lanes = block.mask;
  block.mask = 0;
  return BlockTrace(cast_, kernel_, beams, block).trace_leaves(leaves, end_m, lanes);
}

PrimitiveRef BeamSearch::find(std::size_t beam) const {
  const Beams& all = cast_.request.beams;
  BeamBlock beams;
  HitBlock block;
  block.mask = 1;
  block.beam.fill(beam);
  beams.has_origins = !all.origins_m.empty();
  for (unsigned i = 0; i < kLanes; ++i) {
    beams.direction.set(i, all.directions[beam]);
    if (beams.has_origins) beams.origin_m.set(i, all.origins_m[beam]);
  }
  find(beams, block);
  if (block.mask == 0) return {};
  return {block.instance[0], block.primitive[0]};
}

}  // namespace glidar::rays
