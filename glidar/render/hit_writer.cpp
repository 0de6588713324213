// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/hit_writer.hpp>

#include <glidar/math/simd.hpp>
#include <glidar/render/morton.hpp>
#include <glidar/render/uncertain_hits.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <vector>

namespace glidar {
namespace {

using Box = InstanceTree::Box;

/// A mesh's box in the tree's frame, metres; grown by 16 roundings of single precision.
Box box_in(const Eigen::Matrix3d& tree_from_sensor, const InstanceView& view, const Box& box) {
  constexpr double kBoxRoundingPart = 0x1p-20;  // of distance and size, as in Overlaps
  const Eigen::Matrix<double, 3, 4> placed = tree_from_sensor * sensor_from_object(view);
  const Eigen::Vector3d middle = placed * box.center().homogeneous();
  Eigen::Vector3d half = placed.leftCols<3>().cwiseAbs() * (0.5 * box.sizes());
  const double reach = view.scale * box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm();
  half.array() += kBoxRoundingPart * (middle.norm() + half.norm() + reach);
  return {middle - half, middle + half};
}

std::uint64_t expand_step(double step) {
  return expand_bits(static_cast<std::uint64_t>(step));
}

}  // namespace

void InstanceTree::build(const CastRequest& request, const Resolver& resolver,
                         std::span<const Box> mesh_boxes) {
  const std::vector<Instance>& instances = resolver.scene().instances;
  const auto box_of = [&](std::uint32_t i) { return mesh_boxes[instances[i].mesh]; };
  order_.clear();
  double largest_m = -1.0;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    if (!is_enabled(request, i) || box_of(i).isEmpty()) continue;
    order_.emplace_back(0, i);
    const double size_m = resolver.view(i).scale * box_of(i).diagonal().norm();
    if (!(size_m > largest_m)) continue;
    largest_m = size_m;
    tree_from_sensor_ = resolver.view(i).object_from_sensor;
  }
  boxes_.assign(instances.size(), Box());
  for (const auto& [code, i] : order_) {
    boxes_[i] = box_in(tree_from_sensor_, resolver.view(i), box_of(i));
  }
  sort_instances();
  build_nodes();
  find_shared();
}

/// By their Morton codes.
void InstanceTree::sort_instances() {
  constexpr double kMortonSteps = 65535.0;
  Box middles;
  for (const auto& [code, i] : order_) middles.extend(boxes_[i].center());
  const double size_m = order_.size() < 2 ? 0.0 : middles.sizes().maxCoeff();
  if (!(size_m > 0.0)) return;
  for (auto& [code, i] : order_) {
    const Eigen::Vector3d step = kMortonSteps / size_m * (boxes_[i].center() - middles.min());
    code = expand_step(step.x()) | (expand_step(step.y()) << 1U) | (expand_step(step.z()) << 2U);
  }
  std::sort(order_.begin(), order_.end());
}

void InstanceTree::build_nodes() {
  nodes_.clear();
  level_count_ = 0;
  if (order_.empty()) return;
  for (const auto& [code, i] : order_) nodes_.push_back(boxes_[i]);
  level_begin_[level_count_++] = 0;
  for (std::size_t begin = 0; nodes_.size() - begin > 1;) {
    const std::size_t end = nodes_.size();
    for (std::size_t i = begin; i < end; ++i) {
      if ((i - begin) % kFan == 0) nodes_.emplace_back();
      const Box child = nodes_[i];
      nodes_.back().extend(child);
    }
    level_begin_[level_count_++] = end;
    begin = end;
  }
}

void InstanceTree::find_shared() {
  shared_.assign(boxes_.size(), Box());
  has_overlaps_ = false;
  for (const auto& [code, i] : order_) {
    Box& shared = shared_[i];
    visit_near(boxes_[i], [&, i = i](std::uint32_t other) {
      if (other != i) shared.extend(boxes_[i].intersection(boxes_[other]));
      return !shared.contains(boxes_[i]);
    });
    has_overlaps_ = has_overlaps_ || !shared.isEmpty();
  }
}

namespace {

/// Single precision separates two surfaces only when their distance exceeds this fraction of their
/// range and size: 16 roundings.
constexpr double kSingleRounding = 0x1p-20;

/// The hit points of a block, in the frame of a tree over the instances.
GLIDAR_SIMD void find_points(const BeamBlock& beams, const Lanes<double>& range_m,
                             const Eigen::Matrix3d& tree_from_sensor, Lanes3<double>& points) {
  Lanes3<double> p;
  for (unsigned i = 0; i < kLanes; ++i) p.x[i] = range_m[i] * beams.direction.x[i];
  for (unsigned i = 0; i < kLanes; ++i) p.y[i] = range_m[i] * beams.direction.y[i];
  for (unsigned i = 0; i < kLanes; ++i) p.z[i] = range_m[i] * beams.direction.z[i];
  if (beams.has_origins) {
    for (unsigned i = 0; i < kLanes; ++i) p.x[i] += beams.origin_m.x[i];
    for (unsigned i = 0; i < kLanes; ++i) p.y[i] += beams.origin_m.y[i];
    for (unsigned i = 0; i < kLanes; ++i) p.z[i] += beams.origin_m.z[i];
  }
  rotate(tree_from_sensor, p, points);
}

/// A bit for every lane whose point is in the box.
GLIDAR_SIMD std::uint32_t lanes_in(const Eigen::AlignedBox3d& box, const Lanes3<double>& p) {
  const Eigen::Vector3d& low = box.min();
  const Eigen::Vector3d& high = box.max();
  Lanes<std::uint32_t> bits;
  for (unsigned i = 0; i < kLanes; ++i) {
    const int x = static_cast<int>(p.x[i] >= low.x()) & static_cast<int>(p.x[i] <= high.x());
    const int y = static_cast<int>(p.y[i] >= low.y()) & static_cast<int>(p.y[i] <= high.y());
    const int z = static_cast<int>(p.z[i] >= low.z()) & static_cast<int>(p.z[i] <= high.z());
    bits[i] = static_cast<std::uint32_t>(x & y & z) << i;
  }
  std::uint32_t mask = 0;
  for (unsigned i = 0; i < kLanes; ++i) mask |= bits[i];
  return mask;
}

/// Minimum and maximum of two halves, lane by lane.
template <unsigned kHalf>
inline void fold(Lanes<double>& lows, Lanes<double>& highs) {
  for (unsigned i = 0; i < kHalf; ++i) {
    lows[i] = lows[i + kHalf] < lows[i] ? lows[i + kHalf] : lows[i];
    highs[i] = highs[i + kHalf] > highs[i] ? highs[i + kHalf] : highs[i];
  }
}

/// The extent of these lanes' points along one axis.
[[gnu::always_inline]] inline void find_extent(const Lanes<double>& p, std::uint32_t lanes,
                                               double& low, double& high) {
  static_assert(kLanes == 16);
  constexpr double kNone = std::numeric_limits<double>::infinity();
  Lanes<double> lows;
  Lanes<double> highs;
  for (unsigned i = 0; i < kLanes; ++i) {
    const bool is_in = (lanes & (1U << i)) != 0;
    lows[i] = is_in ? p[i] : kNone;
    highs[i] = is_in ? p[i] : -kNone;
  }
  fold<8>(lows, highs);
  fold<4>(lows, highs);
  fold<2>(lows, highs);
  fold<1>(lows, highs);
  low = lows[0];
  high = highs[0];
}

GLIDAR_SIMD Eigen::AlignedBox3d box_around(const Lanes3<double>& p, std::uint32_t lanes) {
  Eigen::AlignedBox3d box;
  find_extent(p.x, lanes, box.min().x(), box.max().x());
  find_extent(p.y, lanes, box.min().y(), box.max().y());
  find_extent(p.z, lanes, box.min().z(), box.max().z());
  return box;
}

/// A bit for every lane that hit the instance.
std::uint32_t lanes_on(std::uint32_t instance, const HitBlock& block) {
  std::uint32_t mask = 0;
  for (unsigned i = 0; i < kLanes; ++i) {
    mask |= static_cast<std::uint32_t>(block.instance[i] == instance) << i;
  }
  return mask;
}

}  // namespace

Overlaps::Overlaps(const Resolver& resolver, const rays::SceneTrees& trees)
    : resolver_(resolver), trees_(trees) {
  for (std::uint32_t mesh = 0; mesh < resolver.scene().meshes.size(); ++mesh) {
    boxes_.push_back(box_of(trees.of_mesh(mesh)));
  }
}

void Overlaps::prepare(const CastRequest& request) {
  instances_.build(request, resolver_, boxes_);
}

/// The lanes whose points are in the box of one of the instance's triangles. `around` contains all
/// points, in the tree's frame; it rejects most blocks at once.
std::uint32_t Overlaps::lanes_at(std::uint32_t instance, std::uint32_t lanes,
                                 const Eigen::AlignedBox3d& around,
                                 const Lanes3<double>& in_tree) const {
  const InstanceView& view = resolver_.view(instance);
  const rays::MeshTree& tree = trees_.of_instance(instance);
  const Eigen::Matrix3d rotation =
      view.object_from_sensor * instances_.tree_from_sensor().transpose() / view.scale;
  const Eigen::Vector3d middle = rotation * around.center();
  const Eigen::Vector3d half = rotation.cwiseAbs() * (0.5 * around.sizes());
  const double margin = kSingleRounding * (middle.norm() + half.norm() + trees_.reach(instance));
  const Eigen::Vector3d position = view.sensor_in_object + middle;
  if (!has_triangle_near(tree, {position - half, position + half}, margin)) return 0;
  std::uint32_t found = 0;
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(lanes));
    const Eigen::Vector3d point = view.sensor_in_object + rotation * in_tree.get(lane);
    found |= static_cast<std::uint32_t>(has_triangle_near(tree, {point, point}, margin)) << lane;
  }
  return found;
}

std::uint32_t Overlaps::lanes_near(const HitBlock& block, const BeamBlock& beams,
                                   const ExactHits& exact) const {
  Lanes<double> range_m;
  for (unsigned i = 0; i < kLanes; ++i) {
    range_m[i] = exact.distance[i] * resolver_.view(block.instance[i]).scale;
  }
  Lanes3<double> points;
  find_points(beams, range_m, instances_.tree_from_sensor(), points);
  std::uint32_t near = 0;
  for (std::uint32_t rest = block.mask; rest != 0;) {
    const std::uint32_t hit = block.instance[static_cast<unsigned>(std::countr_zero(rest))];
    const std::uint32_t lanes = lanes_on(hit, block) & rest;
    const Eigen::AlignedBox3d& shared = instances_.shared(hit);
    if (!shared.isEmpty()) near |= lanes_in(shared, points) & lanes;
    rest &= ~lanes;
  }
  if (near == 0) return 0;
  std::uint32_t found = 0;
  const Eigen::AlignedBox3d around = box_around(points, near);
  instances_.visit_near(around, [&](std::uint32_t i) {
    const std::uint32_t lanes = near & ~found & ~lanes_on(i, block);
    if (lanes != 0) found |= lanes_at(i, lanes, around, points);
    return found != near;
  });
  return found;
}

namespace {

constexpr std::uint32_t kBlocksPerStep = 8;  // blocks of kLanes columns that are scanned at once
constexpr std::uint32_t kColumnsPerStep = kBlocksPerStep * kLanes;

/// Up to kLanes hits in progress.
struct PixelBatch {
  HitBlock block;
  BeamBlock beams;
  ExactHits exact;
  Lanes<double> x;  ///< where the beams cross the plane at depth 1
  Lanes<double> y;
  Lanes<std::uint32_t> triangle_id;  ///< of the pixel
  std::uint32_t certain = 0;         ///< bit i: lane i certainly hits its triangle
  std::uint32_t contested = 0;       ///< bit i: lane i may hit another triangle first
  unsigned used = 0;
};

/// Three batches are in progress at a time: data that later steps of one need (the corners of
/// its triangles) are prefetched while the next is collected.
struct PixelBatchQueue {
  std::array<PixelBatch, 3> batches;
  std::size_t started = 0;  ///< the last of them is being filled

  PixelBatch& filling() { return batches[started % batches.size()]; }
  PixelBatch& previous() { return batches[(started + batches.size() - 1) % batches.size()]; }
};

/// The primitive to report, see Resolver::canonical_primitive.
std::uint32_t reported_primitive(const HitWriter& w, const PrimitiveRef& ref) {
  return w.request.cull_back_faces ? ref.primitive
                                   : w.resolver.canonical_primitive(ref.instance, ref.primitive);
}

/// Re-tests these lanes by the hit rule; true when that changed the block.
bool recast_lanes(const HitWriter& w, std::uint32_t lanes, const BeamBlock& beams,
                  HitBlock& block) {
  HitBlock exact = block;
  exact.mask = lanes;
  w.search.find(beams, exact);
  bool changed = false;
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(lanes));
    if ((exact.mask >> lane & 1U) == 0) {
      changed = true;
      block.mask &= ~(1U << lane);
      write_misses(w.request.hit_columns, block.beam[lane], 1, w.hits);
      continue;
    }
    changed = changed || block.instance[lane] != exact.instance[lane] ||
              block.primitive[lane] != exact.primitive[lane];
    block.instance[lane] = exact.instance[lane];
    block.primitive[lane] = exact.primitive[lane];
  }
  block.is_one_triangle = block.is_one_triangle && !changed;
  block.is_run = block.is_run && !changed;
  return changed;
}

/// A bit for every lane whose hit is in front of the beam's start.
std::uint32_t ahead(const ExactHits& exact) {
  std::uint32_t mask = 0;
  for (unsigned i = 0; i < kLanes; ++i) {
    mask |= static_cast<std::uint32_t>(exact.distance[i] > 0.0) << i;
  }
  return mask;
}

/// Re-tests hits where surfaces of several instances are too close for the rasterizer.
void resolve_overlaps(const HitWriter& w, PixelBatch& batch) {
  const std::uint32_t lanes = w.overlaps.lanes_near(batch.block, batch.beams, batch.exact);
  if (lanes != 0 && recast_lanes(w, lanes, batch.beams, batch.block) && batch.block.mask != 0) {
    w.resolver.intersect(batch.beams, batch.block, batch.exact);
  }
}

/// Writes the collected hits.
void finish(const HitWriter& w, PixelBatch& batch) {
  if (batch.used == 0) return;
  HitBlock& block = batch.block;
  for (unsigned lane = batch.used; lane < kLanes; ++lane) {
    block.beam[lane] = block.beam[0];
    batch.x[lane] = batch.x[0];
    batch.y[lane] = batch.y[0];
  }
  batch.used = 0;
  directions_through(batch.x, batch.y, batch.beams.direction);
  w.resolver.intersect(batch.beams, block, batch.exact);
  const std::uint32_t uncertain = block.mask & ~(batch.certain & ahead(batch.exact));
  const std::uint32_t beside =
      uncertain == 0 ? 0 : uncertain_lanes(w.resolver, block, batch.exact) & uncertain;
  const std::uint32_t recast = beside | (batch.contested & block.mask);
  if (recast != 0 && recast_lanes(w, recast, batch.beams, block) && block.mask != 0) {
    w.resolver.intersect(batch.beams, block, batch.exact);
  }
  if (block.mask == 0) return;
  if (w.overlaps.has_any()) resolve_overlaps(w, batch);
  if (block.mask == 0) return;
  w.resolver.write(w.request.beams, w.request.hit_columns, block, batch.exact, w.hits);
}

/// What the ids of a batch have in common.
struct IdSummary {
  std::uint32_t certain;    ///< bit i: lane i has kCertainFlag
  std::uint32_t contested;  ///< bit i: lane i has kContestedFlag
  std::uint32_t lowest;     ///< without flags
  std::uint32_t highest;
};

GLIDAR_SIMD IdSummary summarize(const Lanes<std::uint32_t>& ids) {
  std::uint32_t lowest = kNoTriangleId;
  std::uint32_t highest = 0;
  std::uint32_t certain = 0;
  std::uint32_t contested = 0;
  for (unsigned i = 0; i < kLanes; ++i) {
    const std::uint32_t id = ids[i] & kTriangleIdMask;
    lowest = id < lowest ? id : lowest;
    highest = id > highest ? id : highest;
    certain |= ids[i] >> 31U << i;
    contested |= (ids[i] >> 30U & 1U) << i;
  }
  static_assert(kCertainFlag == 1U << 31U && kContestedFlag == 1U << 30U);
  return {.certain = certain, .contested = contested, .lowest = lowest, .highest = highest};
}

/// Sets the triangles of lanes whose ids are all of this instance.
void decode_instance(const HitWriter& w, std::uint32_t instance, PixelBatch& batch) {
  HitBlock& block = batch.block;
  const std::uint32_t first = w.triangles.first(instance);
  for (unsigned i = 0; i < kLanes; ++i) {
    block.instance[i] = instance;
    block.primitive[i] = (batch.triangle_id[i] & kTriangleIdMask) - first;
  }
  const std::uint32_t* reported = w.resolver.first_coincident(instance);
  if (w.request.cull_back_faces || reported == nullptr) return;
  for (std::uint32_t& primitive : block.primitive) primitive = reported[primitive];
}

/// Sets instance and primitive of a lane from its triangle id.
void decode_lane(const HitWriter& w, unsigned lane, PixelBatch& batch) {
  const PrimitiveRef ref = w.triangles.decode(batch.triangle_id[lane]);
  batch.block.instance[lane] = ref.instance;
  batch.block.primitive[lane] = reported_primitive(w, ref);
}

/// Sets instance and primitive of the hits from the triangle ids, and prefetches the triangles.
void decode_triangles(const HitWriter& w, PixelBatch& batch) {
  HitBlock& block = batch.block;
  block.mask = static_cast<std::uint32_t>((std::uint64_t{1} << batch.used) - 1);
  if (block.mask == 0) return;
  for (unsigned lane = batch.used; lane < kLanes; ++lane) {
    batch.triangle_id[lane] = batch.triangle_id[0];
  }
  const IdSummary ids = summarize(batch.triangle_id);
  batch.certain = ids.certain;
  batch.contested = ids.contested;
  block.is_one_triangle = ids.lowest == ids.highest;
  const std::uint32_t instance = w.triangles.instance_of(ids.lowest);
  if (ids.highest < w.triangles.end(instance)) {
    decode_instance(w, instance, batch);
    w.resolver.prefetch_one_instance(block);
  } else {
    for (unsigned lane = 0; lane < kLanes; ++lane) {
      decode_lane(w, lane, batch);
      w.resolver.prefetch(block, lane);
    }
  }
}

/// Decodes the collected batch, prefetches the corners of the batch before, and finishes the
/// oldest.
void advance(const HitWriter& w, PixelBatchQueue& queue) {
  decode_triangles(w, queue.filling());
  const PixelBatch& previous = queue.previous();
  HitColumnMask hit_columns = w.request.hit_columns;
  // To find its uncertain lanes.
  hit_columns.barycentrics =
      hit_columns.barycentrics || (previous.block.mask & ~previous.certain) != 0;
  w.resolver.prefetch_corners(previous.block, hit_columns);
  ++queue.started;
  finish(w, queue.filling());
}

/// Finds the non-empty pixels of a section of a row: a bit for each, kLanes per mask.
GLIDAR_SIMD void find_filled(const std::uint32_t* triangle_ids, std::uint32_t count,
                             std::array<std::uint32_t, kBlocksPerStep>& masks) {
  const std::uint32_t whole = count / kLanes;
  for (std::uint32_t block = 0; block < whole; ++block) {
    const std::uint32_t* const ids = triangle_ids + std::size_t{block} * kLanes;
    std::uint32_t mask = 0;
    for (unsigned i = 0; i < kLanes; ++i) {
      mask |= static_cast<std::uint32_t>(ids[i] != kNoTriangleId) << i;
    }
    masks[block] = mask;
  }
  std::uint32_t mask = 0;
  for (std::uint32_t i = whole * kLanes; i < count; ++i) {
    mask |= static_cast<std::uint32_t>(triangle_ids[i] != kNoTriangleId) << (i % kLanes);
  }
  if (whole < kBlocksPerStep) masks[whole] = mask;
}

/// A row of `written`.
struct RowPixels {
  const std::uint32_t* triangle_ids;  ///< per column of `written`
  std::size_t first_beam;
  double y;  ///< where its beams cross the plane at depth 1
};

/// Sets a batch to kLanes pixels in a row from a column on.
GLIDAR_SIMD void set_run(const RowPixels& row, const double* x, std::uint32_t col,
                         PixelBatch& __restrict batch) {
  const std::uint32_t* const ids = row.triangle_ids + col;
  for (unsigned i = 0; i < kLanes; ++i) batch.triangle_id[i] = ids[i];
  for (unsigned i = 0; i < kLanes; ++i) batch.x[i] = x[col + i];
  for (unsigned i = 0; i < kLanes; ++i) batch.y[i] = row.y;
  for (unsigned i = 0; i < kLanes; ++i) batch.block.beam[i] = row.first_beam + col + i;
  batch.used = kLanes;
  batch.block.is_run = true;
}

/// Adds a pixel of a row to a batch.
void add_pixel(const RowPixels& row, const double* x, std::uint32_t col, PixelBatch& batch) {
  const unsigned lane = batch.used++;
  batch.block.is_run = false;
  batch.triangle_id[lane] = row.triangle_ids[col];
  batch.x[lane] = x[col];
  batch.y[lane] = row.y;
  batch.block.beam[lane] = row.first_beam + col;
}

/// The beams of a row of `written`.
BeamRange beams_of(const HitWriter& w, std::uint32_t row) {
  const std::size_t first =
      std::size_t{w.written.first_row + row} * w.request.beams.cols + w.written.first_col;
  return {first, first + w.written.cols};
}

/// Batches in progress: of adjacent pixels, and of those between empty ones.
struct PixelQueues {
  PixelBatchQueue runs;
  PixelBatchQueue others;
};

void collect_row(const HitWriter& w, std::uint32_t row, PixelQueues& queues) {
  const std::uint32_t drawn_row = w.written.first_row - w.drawn.first_row + row;
  const std::uint32_t drawn_col = w.written.first_col - w.drawn.first_col;
  const RowPixels pixels = {
      .triangle_ids = w.triangle_ids.data() + std::size_t{drawn_row} * w.drawn.cols + drawn_col,
      .first_beam = beams_of(w, row).begin,
      .y = w.points.y[w.written.first_row + row]};
  const double* const x = w.points.x.data() + w.written.first_col;
  std::array<std::uint32_t, kBlocksPerStep> masks{};
  std::uint32_t first_miss = 0;  // misses are written in long runs, and hits over them
  const auto write_misses_until = [&](std::uint32_t end) {
    if (first_miss >= end) return;
    write_misses(w.request.hit_columns, pixels.first_beam + first_miss, end - first_miss, w.hits);
  };
  for (std::uint32_t col = 0; col < w.written.cols; col += kLanes) {
    if (col % kColumnsPerStep == 0) {
      find_filled(pixels.triangle_ids + col, std::min(kColumnsPerStep, w.written.cols - col),
                  masks);
    }
    const std::uint32_t filled = masks[col % kColumnsPerStep / kLanes];
    if (filled == 0) continue;
    const std::uint32_t next = std::min(col + kLanes, w.written.cols);
    write_misses_until(filled == (1U << (next - col)) - 1U ? col : next);
    first_miss = next;
    if (filled == kAllLanes) {
      set_run(pixels, x, col, queues.runs.filling());
      advance(w, queues.runs);
      continue;
    }
    for_lanes(filled, [&](unsigned i) {
      PixelBatch& batch = queues.others.filling();
      add_pixel(pixels, x, col + i, batch);
      if (batch.used == kLanes) advance(w, queues.others);
    });
  }
  write_misses_until(w.written.cols);
}

}  // namespace

DepthRange depths_of(const CastRequest& request, const Resolver& resolver,
                     std::span<const Eigen::AlignedBox3d> mesh_boxes) {
  double nearest_m = std::numeric_limits<double>::infinity();
  double farthest_m = -std::numeric_limits<double>::infinity();
  const std::vector<Instance>& instances = resolver.scene().instances;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    if (!is_enabled(request, i)) continue;
    extend_depths(resolver.view(i), mesh_boxes[instances[i].mesh], nearest_m, farthest_m);
  }
  if (!(farthest_m > 0.0)) return {0.0, 0.0};
  return tight_depth_range(nearest_m, farthest_m);
}

void write_rows(const HitWriter& w, std::uint32_t begin, std::uint32_t end) {
  PixelQueues queues;
  for (std::uint32_t row = begin; row < end; ++row) collect_row(w, row, queues);
  for (PixelBatchQueue* queue : {&queues.runs, &queues.others}) {
    for (std::size_t i = 0; i < queue->batches.size(); ++i) advance(w, *queue);
  }
  if (!w.request.on_tile_done) return;
  for (std::uint32_t row = begin; row < end; ++row) w.request.on_tile_done(beams_of(w, row));
}

}  // namespace glidar
