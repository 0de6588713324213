// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/hit_writer.hpp>

#include <glidar/math/simd.hpp>
#include <glidar/render/uncertain_hits.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <vector>

namespace glidar {
namespace {

constexpr std::uint32_t kColumnsPerStep = 128;  // columns that are scanned at once

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

/// Three batches are in progress at a time: data that later steps of one need (planes and corners
/// of its triangles) are prefetched while the next is collected.
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

/// The lanes that hit one of the close triangles.
std::uint32_t close_lanes(const HitWriter& w, const HitBlock& block) {
  std::uint32_t lanes = 0;
  for_lanes(block.mask, [&](unsigned lane) {
    const std::uint32_t instance = block.instance[lane];
    const std::uint32_t primitive = w.resolver.canonical_primitive(instance, block.primitive[lane]);
    const bool is_close = w.close_triangles->is_close(instance, primitive);
    lanes |= static_cast<std::uint32_t>(is_close) << lane;
  });
  return lanes;
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
  bool is_one_triangle;
};

GLIDAR_SIMD IdSummary summarize(const Lanes<std::uint32_t>& ids) {
  const std::uint32_t first = ids[0];
  Lanes<std::uint32_t> certain;
  Lanes<std::uint32_t> contested;
  std::uint32_t differing = 0;
  for (unsigned i = 0; i < kLanes; ++i) {
    certain[i] = static_cast<std::uint32_t>((ids[i] & kCertainFlag) != 0) << i;
    contested[i] = static_cast<std::uint32_t>((ids[i] & kContestedFlag) != 0) << i;
    differing |= (ids[i] ^ first) & kTriangleIdMask;
  }
  IdSummary summary{.certain = 0, .contested = 0, .is_one_triangle = differing == 0};
  for (unsigned i = 0; i < kLanes; ++i) summary.certain |= certain[i];
  for (unsigned i = 0; i < kLanes; ++i) summary.contested |= contested[i];
  return summary;
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
  block.is_run = batch.used == kLanes && block.beam[kLanes - 1] - block.beam[0] == kLanes - 1;
  for (unsigned lane = batch.used; lane < kLanes; ++lane) {
    batch.triangle_id[lane] = batch.triangle_id[0];
  }
  const IdSummary ids = summarize(batch.triangle_id);
  batch.certain = ids.certain;
  batch.contested = ids.contested;
  block.is_one_triangle = ids.is_one_triangle;
  const bool with_corners = needs_corners(w.request.hit_columns);
  decode_lane(w, 0, batch);
  w.resolver.prefetch(block, 0, with_corners);
  if (block.is_one_triangle) {
    block.instance.fill(block.instance[0]);
    block.primitive.fill(block.primitive[0]);
  }
  for (unsigned lane = 1; lane < batch.used && !block.is_one_triangle; ++lane) {
    decode_lane(w, lane, batch);
    w.resolver.prefetch(block, lane, with_corners);
  }
  if (w.close_triangles != nullptr) batch.contested |= close_lanes(w, block);
}

/// Decodes the collected batch, prefetches the corners of the batch before, and finishes the
/// oldest.
void advance(const HitWriter& w, PixelBatchQueue& queue) {
  decode_triangles(w, queue.filling());
  PixelBatch& previous = queue.previous();
  HitColumnMask hit_columns = w.request.hit_columns;
  // To find its uncertain lanes.
  hit_columns.barycentrics =
      hit_columns.barycentrics || (previous.block.mask & ~previous.certain) != 0;
  w.resolver.prefetch_corners(previous.block, hit_columns);
  ++queue.started;
  finish(w, queue.filling());
}

/// Lists the non-empty columns in a section of a row; returns their number.
std::uint32_t list_filled(const std::uint32_t* triangle_ids, std::uint32_t begin, std::uint32_t end,
                          std::array<std::uint32_t, kColumnsPerStep>& cols) {
  std::uint32_t count = 0;
  for (std::uint32_t col = begin; col < end;
       ++col) {  // without a branch, which would often be mispredicted
    cols[count] = col;
    count += triangle_ids[col] != kNoTriangleId ? 1U : 0U;
  }
  return count;
}

/// A row of `written`.
struct RowPixels {
  const std::uint32_t* triangle_ids;  ///< per column of `written`
  std::size_t first_beam;
  std::uint32_t first_col;  ///< of the image
  double y;                 ///< where its beams cross the plane at depth 1
};

/// Adds the pixels in these columns of a row to a batch.
void collect(const HitWriter& w, const RowPixels& row, std::span<const std::uint32_t> cols,
             PixelBatch& batch) {
  const unsigned first = batch.used;
  const auto count = static_cast<unsigned>(cols.size());
  const double* const x = w.points.x.data() + row.first_col;
  for (unsigned i = 0; i < count; ++i) batch.triangle_id[first + i] = row.triangle_ids[cols[i]];
  for (unsigned i = 0; i < count; ++i) batch.x[first + i] = x[cols[i]];
  for (unsigned i = 0; i < count; ++i) batch.y[first + i] = row.y;
  for (unsigned i = 0; i < count; ++i) batch.block.beam[first + i] = row.first_beam + cols[i];
  batch.used += count;
}

/// The beams of a row of `written`.
BeamRange beams_of(const HitWriter& w, std::uint32_t row) {
  const std::size_t first =
      std::size_t{w.written.first_row + row} * w.request.beams.cols + w.written.first_col;
  return {first, first + w.written.cols};
}

void collect_row(const HitWriter& w, std::uint32_t row, PixelBatchQueue& queue) {
  const std::uint32_t drawn_row = w.written.first_row - w.drawn.first_row + row;
  const std::uint32_t drawn_col = w.written.first_col - w.drawn.first_col;
  const RowPixels pixels = {
      .triangle_ids = w.triangle_ids.data() + std::size_t{drawn_row} * w.drawn.cols + drawn_col,
      .first_beam = beams_of(w, row).begin,
      .first_col = w.written.first_col,
      .y = w.points.y[w.written.first_row + row]};
  std::array<std::uint32_t, kColumnsPerStep> cols;
  for (std::uint32_t begin = 0; begin < w.written.cols; begin += kColumnsPerStep) {
    const std::uint32_t end = std::min(begin + kColumnsPerStep, w.written.cols);
    const std::uint32_t count = list_filled(pixels.triangle_ids, begin, end, cols);
    // Misses are written in long runs, and hits over them.
    if (count < end - begin) {
      write_misses(w.request.hit_columns, pixels.first_beam + begin, end - begin, w.hits);
    }
    for (std::uint32_t done = 0; done < count;) {
      PixelBatch& batch = queue.filling();
      const std::uint32_t added = std::min(kLanes - batch.used, count - done);
      collect(w, pixels, std::span(cols).subspan(done, added), batch);
      if (batch.used == kLanes) advance(w, queue);
      done += added;
    }
  }
}

/// Overwrites pixels by the hits of cast beams. Beams of the range in columns outside of `written`
/// are not among them.
void write_cast_hits(const HitWriter& w, const BeamRange& beams) {
  const auto first =
      std::lower_bound(w.cast_hits.begin(), w.cast_hits.end(), beams.begin,
                       [](const CastHit& hit, std::size_t beam) { return hit.beam < beam; });
  PixelBatch batch;
  batch.certain = 0xffffffffU;
  batch.block.mask = 0;
  for (auto hit = first; hit != w.cast_hits.end() && hit->beam < beams.end; ++hit) {
    if (hit->primitive.instance == kInvalidId) {
      write_misses(w.request.hit_columns, hit->beam, 1, w.hits);
      continue;
    }
    const unsigned lane = batch.used++;
    batch.x[lane] = w.points.x[hit->beam % w.request.beams.cols];
    batch.y[lane] = w.points.y[hit->beam / w.request.beams.cols];
    batch.block.beam[lane] = hit->beam;
    batch.block.instance[lane] = hit->primitive.instance;
    batch.block.primitive[lane] = reported_primitive(w, hit->primitive);
    batch.block.mask |= 1U << lane;
    if (batch.used < kLanes) continue;
    finish(w, batch);
    batch.block.mask = 0;
  }
  finish(w, batch);
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
  PixelBatchQueue queue;
  for (std::uint32_t row = begin; row < end; ++row) collect_row(w, row, queue);
  for (std::size_t i = 0; i < queue.batches.size(); ++i) advance(w, queue);
  if (!w.cast_hits.empty())
    write_cast_hits(w, {beams_of(w, begin).begin, beams_of(w, end - 1).end});
  if (!w.request.on_tile_done) return;
  for (std::uint32_t row = begin; row < end; ++row) w.request.on_tile_done(beams_of(w, row));
}

void write_image(const HitWriter& writer, ThreadPool& thread_pool, ProgressCounter& count) {
  constexpr std::uint32_t kBeamsPerTask = 1024;
  const PixelRect& written = writer.written;
  const std::uint32_t rows_per_task = std::max(1U, kBeamsPerTask / written.cols);
  thread_pool.parallel_for(written.rows, rows_per_task, [&](std::size_t begin, std::size_t end) {
    const auto last = static_cast<std::uint32_t>(end);
    for (auto row = static_cast<std::uint32_t>(begin); row < last; row += rows_per_task) {
      const std::uint32_t next = std::min(row + rows_per_task, last);
      write_rows(writer, row, next);
      count.add(std::size_t{next - row} * written.cols);
    }
  });
}

}  // namespace glidar
