// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/footprint_search.hpp>

#include <glidar/math/constants.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace glidar::rays {
namespace {

/// A triangle that sub-rays of a footprint may hit.
struct PossibleHit {
  double low_m;
  LeafRef leaf;
  std::uint32_t slot;
  bool is_certain;
};

/// All triangles that sub-rays of a footprint may hit up to `end_m`.
struct PossibleHits {
  double end_m = kInfinity;
  unsigned count = 0;
  std::array<PossibleHit, kMaxConeHits> hit;

  void forget_farther() {
    const auto end = hit.begin() + count;
    const auto is_farther = [&](const PossibleHit& h) { return h.low_m > end_m; };
    count = static_cast<unsigned>(std::remove_if(hit.begin(), end, is_farther) - hit.begin());
  }
};

/// Beams that wait until a packet is full.
struct WaitingBeams {
  unsigned count = 0;
  HitBlock block;
  Lanes<double> end_m;
  std::size_t leaves = 0;
  std::array<LeafRef, std::size_t{kLanes} * kMaxConeHits> leaf;

  /// True when the packet is full.
  bool add(std::size_t beam, double end) {
    block.beam[count] = beam;
    end_m[count] = end;
    return ++count == kLanes;
  }
};

/// After a bundle of which most cones meet too many triangles, so many are traced ray by ray.
constexpr unsigned kDense = 15;

/// Sixteen footprints around their first sub-rays.
struct Bundle {
  BeamBlock middle;
  std::uint32_t usable = 0;  ///< lanes whose directions are finite and whose origins are in reach
  double radius_m = 0.0;     ///< of the footprints, and of rounding
};

/// Traces the footprints of a range.
class FootprintTrace {
 public:
  FootprintTrace(const BeamSearch& search, Hits& hits) : search_(search), hits_(hits) {}

  void trace(BeamRange footprints, std::span<FootprintWay> ways) {
    ways_ = ways;
    first_ = footprints.begin;
    std::fill(hits_.instance.begin() + static_cast<std::ptrdiff_t>(footprints.begin * size_),
              hits_.instance.begin() + static_cast<std::ptrdiff_t>(footprints.end * size_),
              kInvalidId);
    unsigned dense = 0;  // bundles that are not tried, because one before met too many triangles
    for (std::size_t i = footprints.begin; i < footprints.end; i += kLanes) {
      const BeamRange bundle{i, std::min(i + kLanes, footprints.end)};
      if (dense > 0) {
        --dense;
        for (std::size_t k = bundle.begin; k < bundle.end; ++k) add_others(k);
        continue;
      }
      trace_bundle(bundle);
      if (std::popcount(overflowed_) > static_cast<int>(kLanes / 2)) dense = kDense;
    }
    if (unsure_.count > 0) find_unsure();
    if (others_.count > 0) find_others();
  }

 private:
  void trace_bundle(BeamRange footprints) {
    gather(footprints);
    for (PossibleHits& found : found_) {
      found.end_m = kInfinity;
      found.count = 0;
    }
    overflowed_ = 0;
    if (bundle_.usable != 0) trace_cones();
    for (std::size_t i = footprints.begin; i < footprints.end; ++i) {
      const auto lane = static_cast<unsigned>(i - footprints.begin);
      const bool is_searched = ((bundle_.usable & ~overflowed_) >> lane & 1U) != 0;
      if (is_searched) {
        decide(i, found_[lane]);
      } else {
        add_others(i);
      }
    }
  }

  void gather(BeamRange footprints) {
    const auto lanes = static_cast<unsigned>(footprints.end - footprints.begin);
    BeamBlock& middle = bundle_.middle;
    middle.has_origins = !beams_.origins_m.empty();
    bundle_.usable = 0;
    double farthest_m = 0.0;
    for (unsigned lane = 0; lane < kLanes; ++lane) {  // unused lanes repeat the last
      const std::size_t beam = (footprints.begin + std::min(lane, lanes - 1)) * size_;
      const Eigen::Vector3d& d = beams_.directions[beam];
      middle.direction.set(lane, d);
      double size_m = 0.0;
      if (middle.has_origins) {
        const Eigen::Vector3d& o = beams_.origins_m[beam];
        middle.origin_m.set(lane, o);
        size_m = std::abs(o.x()) + std::abs(o.y()) + std::abs(o.z());
      }
      const double sum = d.x() + d.y() + d.z() + size_m;
      if (lane >= lanes || sum - sum != 0.0 || size_m > kMaxCoordinate_m) continue;
      bundle_.usable |= 1U << lane;
      farthest_m = std::max(farthest_m, size_m);
    }
    // Rotations round origins by some 2^-51.
    bundle_.radius_m = cast_.request.footprints.radius_m + 0x1p-48 * farthest_m;
  }

  void trace_cones() {
    if (cast_.trees.instances().size() == 1) {
      visit(cast_.trees.instances()[0], bundle_.usable);
      return;
    }
    RayPacket packet;
    set_rays(tree_view(cast_.trees), bundle_.middle, packet);
    for (const InstanceGroup& group : cast_.trees.groups()) {
      const std::uint32_t lanes = bundle_.usable & ~overflowed_;
      if (lanes == 0) return;
      group_ = &group;
      start(packet, group.boxes.sphere(), 1.0, lanes);
      for_lanes(lanes, [&](unsigned i) { packet.high[i] = bound_in(packet, i, found_[i].end_m); });
      search_.kernel().visit_cone_leaves(
          group.tree(), packet, cones_,
          [](void* self, std::uint32_t leaf, RayPacket& outer, std::uint32_t entering) {
            static_cast<FootprintTrace*>(self)->visit_leaf(leaf, outer, entering);
          },
          this);
    }
  }

  void visit_leaf(std::uint32_t leaf, RayPacket& outer, std::uint32_t lanes) {
    visit(group_->boxes.index_in(leaf), lanes);
    outer.active &= ~overflowed_;
    for_lanes(lanes, [&](unsigned i) {
      const bool has_ended = (overflowed_ >> i & 1U) != 0;
      outer.high[i] = has_ended ? -kInfinityf : bound_in(outer, i, found_[i].end_m);
    });
  }

  /// Starts a packet for cones around its rays: no sub-ray meets the mesh before the shift of its
  /// cone, because the mesh's sphere is larger by their distance.
  void start(RayPacket& packet, const MeshSphere& sphere, double scale, std::uint32_t lanes) {
    cones_.slope = static_cast<float>((cast_.request.footprints.slope + 0x1p-48) * (1.0 + 0x1p-20));
    cones_.radius = static_cast<float>(bundle_.radius_m / scale * (1.0 + 0x1p-20));
    double squared = 0.0;
    for_lanes(lanes, [&](unsigned i) {
      double sum = 0.0;
      for (unsigned axis = 0; axis < 3; ++axis) {
        const double x = packet.exact_origin[axis][i] - sphere.centre[axis];
        sum += x * x;
      }
      squared = std::max(squared, sum);
    });
    const double far = std::sqrt(squared);
    const double from_zero = far + Eigen::Vector3d(sphere.centre).norm();
    MeshSphere wider = sphere;
    wider.radius += double{cones_.radius} + double{cones_.slope} * far + 0x1p-46 * from_zero;
    packet.tie_reach = cast_.trees.max_reach_m() / scale;
    search_.kernel().start(packet, wider, lanes);
  }

  /// Adds what sub-rays may hit in an instance.
  void visit(std::uint32_t instance, std::uint32_t lanes) {
    const InstanceView& view = cast_.resolver.view(instance);
    const MeshTree& tree = cast_.trees.of_instance(instance);
    RayPacket& p = packet_;
    set_rays(view, bundle_.middle, p);
    start(p, tree.sphere, view.scale, lanes);
    for_lanes(lanes, [&](unsigned i) {
      p.high[i] = bound_in(p, i, found_[i].end_m / view.scale);
      cones_.count[i] = 0;
    });
    cones_.may_pass = cast_.resolver.is_masked(instance);
    cones_.overflowed = 0;
    search_.kernel().trace_cones(tree.view(), p, cones_);
    overflowed_ |= cones_.overflowed;
    for_lanes(lanes & ~overflowed_, [&](unsigned i) { collect(instance, view.scale, i); });
  }

  void collect(std::uint32_t instance, double scale, unsigned lane) {
    if (cones_.count[lane] == 0) return;
    const double shift = packet_.shift[lane];
    const double margin = 0x1p-50 * shift;
    const double high = packet_.high[lane];
    PossibleHits& found = found_[lane];
    found.end_m = std::min(found.end_m, scale * ((shift + high) * (1.0 - 0x1p-50) - margin));
    found.forget_farther();
    for (unsigned k = 0; k < cones_.count[lane]; ++k) {
      const ConeHit& hit = cones_.hit[lane][k];
      const double low_m = scale * (shift + double{hit.low} - margin);
      if (low_m > found.end_m) continue;
      if (found.count == kMaxConeHits) {
        overflowed_ |= 1U << lane;
        return;
      }
      found.hit[found.count++] = {low_m, {instance, hit.cluster}, hit.slot, hit.is_certain};
    }
  }

  void decide(std::size_t footprint, PossibleHits& found) {
    found.forget_farther();
    if (found.count == 0) return note(footprint, FootprintWay::nothing);
    const std::size_t first = footprint * size_;
    const bool is_one = found.count == 1 && found.hit[0].is_certain;
    note(footprint, is_one ? FootprintWay::one_triangle : FootprintWay::candidates);
    if (is_one) return hit_all(first, found.hit[0]);
    for (std::size_t beam = first; beam < first + size_; ++beam) {
      if (beam == first || unsure_.count == 0) add_leaves(found);
      if (unsure_.add(beam, found.end_m)) find_unsure();
    }
  }

  void note(std::size_t footprint, FootprintWay way) {
    if (!ways_.empty()) ways_[footprint - first_] = way;
  }

  void hit_all(std::size_t first, const PossibleHit& hit) {
    const MeshTree& tree = cast_.trees.of_instance(hit.leaf.instance);
    const std::uint32_t primitive =
        tree.blocks[hit.slot / kBlockSize].primitive[hit.slot % kBlockSize];
    for (std::size_t beam = first; beam < first + size_; ++beam) {
      hits_.instance[beam] = hit.leaf.instance;
      hits_.primitive[beam] = primitive;
    }
  }

  void add_leaves(const PossibleHits& found) {
    for (unsigned k = 0; k < found.count; ++k) unsure_.leaf[unsure_.leaves++] = found.hit[k].leaf;
  }

  /// The sub-rays of a footprint.
  void add_others(std::size_t footprint) {
    note(footprint, FootprintWay::single);
    for (std::size_t beam = footprint * size_; beam < (footprint + 1) * size_; ++beam) {
      add_other(beam);
    }
  }

  void add_other(std::size_t beam) {
    if (others_.add(beam, kInfinity)) find_others();
  }

  /// Gathers waiting beams; unused lanes repeat the last.
  void gather(WaitingBeams& waiting, BeamBlock& block) const {
    waiting.block.mask = (1U << waiting.count) - 1U;
    block.has_origins = !beams_.origins_m.empty();
    for (unsigned lane = 0; lane < kLanes; ++lane) {
      if (lane >= waiting.count) waiting.block.beam[lane] = waiting.block.beam[lane - 1];
      const std::size_t beam = waiting.block.beam[lane];
      block.direction.set(lane, beams_.directions[beam]);
      if (block.has_origins) block.origin_m.set(lane, beams_.origins_m[beam]);
    }
    waiting.count = 0;
  }

  void write(const HitBlock& block) {
    for_lanes(block.mask, [&](unsigned i) {
      hits_.instance[block.beam[i]] = block.instance[i];
      hits_.primitive[block.beam[i]] = block.primitive[i];
    });
  }

  void find_unsure() {
    BeamBlock block;
    gather(unsure_, block);
    const std::uint32_t lanes = unsure_.block.mask;
    const auto begin = unsure_.leaf.begin();
    const auto end = begin + static_cast<std::ptrdiff_t>(unsure_.leaves);
    std::sort(begin, end);
    const auto count = static_cast<std::size_t>(std::unique(begin, end) - begin);
    unsure_.leaves = 0;
    const std::uint32_t decided =
        search_.find_among({unsure_.leaf.data(), count}, unsure_.end_m, block, unsure_.block);
    write(unsure_.block);
    for_lanes(lanes & ~decided, [&](unsigned i) { add_other(unsure_.block.beam[i]); });
  }

  void find_others() {
    BeamBlock block;
    gather(others_, block);
    search_.find(block, others_.block);
    write(others_.block);
  }

  const BeamSearch& search_;
  Hits& hits_;
  std::span<FootprintWay> ways_;  ///< of the range that is traced
  std::size_t first_ = 0;         ///< footprint of the range
  const CastView& cast_ = search_.cast();
  const Beams& beams_ = cast_.request.beams;
  const std::size_t size_ = cast_.request.footprints.beams;
  Bundle bundle_;
  std::array<PossibleHits, kLanes> found_;
  std::uint32_t overflowed_ = 0;
  const InstanceGroup* group_ = nullptr;  ///< that is being traced
  RayPacket packet_;                      ///< in the instance that is being visited
  Cones cones_;
  WaitingBeams unsure_;  ///< traced to the triangles that their footprints may hit
  WaitingBeams others_;  ///< traced alone
};

}  // namespace

bool FootprintSearch::is_useful() const {
  const CastRequest& request = beams_.cast().request;
  return request.footprints.beams > 1 && request.footprints.slope <= kMaxSlope &&
         request.beams.rows == 1 && request.targets.empty() && !request.cull_back_faces &&
         !beams_.cast().trees.instances().empty();
}

void FootprintSearch::find(BeamRange footprints, Hits& hits, std::span<FootprintWay> ways) const {
  FootprintTrace(beams_, hits).trace(footprints, ways);
}

}  // namespace glidar::rays
