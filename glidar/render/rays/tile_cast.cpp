// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/tile_cast.hpp>

#include <glidar/core/report.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/render/grid_window.hpp>
#include <glidar/render/rays/tiles.hpp>
#include <glidar/render/resolver.hpp>

#include <array>
#include <numeric>

namespace glidar::rays {
namespace {

// About 50 microseconds of work, and its hits fit into a core's private cache.
constexpr std::size_t kTilesPerTask = 64;

/// Inputs that all tiles of a cast share.
struct Job {
  const Beams& beams;
  const PlanePoints& points;
  GridWindow window;  ///< beams outside of it miss
  const HitColumnMask& hit_columns;
  const Resolver& resolver;
  const BeamSearch& search;
  bool is_searched;  ///< the hits have instances and primitives
  Hits& hits;
};

/// Collects the beams of a tile that is completely in a pinhole's grid.
void gather_pinhole(const PlanePoints& points, const Tile& tile, HitBatch& batch) {
  const std::uint32_t column_mask = (1U << tile.width_shift) - 1U;
  Lanes<double> x;
  Lanes<double> y;
  const std::size_t first = tile.beam(0);
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    const std::uint32_t row = lane >> tile.width_shift;
    const std::uint32_t col = lane & column_mask;
    x[lane] = points.x[tile.first_col + col];
    y[lane] = points.y[tile.first_row + row];
    batch.block.beam[lane] = first + std::size_t{row} * tile.cols + col;
  }
  batch.block.mask = (1U << kLanes) - 1U;
  directions_through(x, y, batch.beams.direction);
}

/// Copies kLanes vectors. Whole vectors are written, since vectors written one number at a time are
/// slow to load.
GLIDAR_SIMD void copy_run(const double* xyz, Lanes3<double>& to) {
  for (unsigned i = 0; i < kLanes; ++i) to.x[i] = xyz[std::size_t{3} * i];
  for (unsigned i = 0; i < kLanes; ++i) to.y[i] = xyz[std::size_t{3} * i + 1];
  for (unsigned i = 0; i < kLanes; ++i) to.z[i] = xyz[std::size_t{3} * i + 2];
}

/// Collects the beams from `first` on.
void gather_run(const Beams& beams, std::size_t first, HitBatch& batch) {
  batch.block.mask = (1U << kLanes) - 1U;
  std::iota(batch.block.beam.begin(), batch.block.beam.end(), first);
  copy_run(beams.directions[first].data(), batch.beams.direction);
  batch.beams.has_origins = !beams.origins_m.empty();
  if (batch.beams.has_origins) copy_run(beams.origins_m[first].data(), batch.beams.origin_m);
}

/// Collects the tile's beams; lanes beyond the grid's border repeat the first, outside of the mask.
void gather_beams(const Beams& beams, const Tile& tile, HitBatch& batch) {
  const bool whole = tile.is_whole(kLanes);
  const std::size_t first = tile.beam(0);
  const std::uint32_t column_mask = (1U << tile.width_shift) - 1U;
  if (whole && column_mask == kLanes - 1U) return gather_run(beams, first, batch);
  batch.block.mask = 0;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    const std::size_t beam =
        first + std::size_t{lane >> tile.width_shift} * tile.cols + (lane & column_mask);
    const bool inside = whole || tile.beam(lane) != Tile::kOutside;
    batch.block.mask |= static_cast<std::uint32_t>(inside) << lane;
    batch.block.beam[lane] = inside ? beam : first;
    batch.beams.direction.set(lane, beams.directions[batch.block.beam[lane]]);
  }
  batch.beams.has_origins = !beams.origins_m.empty();
  if (!batch.beams.has_origins) return;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    batch.beams.origin_m.set(lane, beams.origins_m[batch.block.beam[lane]]);
  }
}

/// Prefetches a tile's beams.
void prefetch(const Beams& beams, const Tile& tile) {
  for (unsigned lane = 0; lane < kLanes; lane += 2) {  // two directions and a half per cache line
    const std::size_t beam = tile.beam(lane);
    if (beam == Tile::kOutside) continue;
    __builtin_prefetch(&beams.directions[beam]);
    if (!beams.origins_m.empty()) __builtin_prefetch(&beams.origins_m[beam]);
  }
}

/// Prefetches the triangles of the block's hits, and sets what the hits have in common.
void prepare_hits(const Job& job, bool is_run, HitBlock& block) {
  constexpr std::uint32_t kAll = (1U << kLanes) - 1U;
  block.is_one_triangle = true;
  block.is_run = is_run && block.mask == kAll;
  PrimitiveRef last;
  for_lanes(block.mask, [&](unsigned lane) {
    if (block.primitive[lane] == last.primitive && block.instance[lane] == last.instance) return;
    block.is_one_triangle = last.instance == kInvalidId;
    last = {block.instance[lane], block.primitive[lane]};
    job.resolver.prefetch(block, lane);
  });
}

/// Takes what was found before.
void take_found(const Hits& hits, HitBlock& block) {
  for_lanes(block.mask, [&](unsigned lane) {
    block.instance[lane] = hits.instance[block.beam[lane]];
    block.primitive[lane] = hits.primitive[block.beam[lane]];
    if (block.instance[lane] == kInvalidId) block.mask &= ~(1U << lane);
  });
}

/// Collects and traces the beams of tile i.
void start(const Job& job, const Tiling& tiling, std::size_t i, std::size_t end, HitBatch& batch) {
  const Tile tile = tiling.tile(i);
  batch.block.mask = 0;
  batch.block.is_run = false;
  if (!job.window.meets(tile.window(kLanes))) return;
  if (!job.points.x.empty() && tile.is_whole(kLanes)) {
    gather_pinhole(job.points, tile, batch);
  } else {
    gather_beams(job.beams, tile, batch);
    if (i + 1 < end) prefetch(job.beams, tiling.tile(i + 1));
  }
  if (job.is_searched) {
    take_found(job.hits, batch.block);
  } else {
    job.search.find(batch.beams, batch.block);
  }
  prepare_hits(job, tiling.has_runs(), batch.block);
}

/// Writes misses to tiles [begin, end).
void write_tile_misses(const Job& job, const Tiling& tiling, std::size_t begin, std::size_t end) {
  tiling.for_beam_rows(begin, end, [&](BeamRange row) {
    write_misses(job.hit_columns, row.begin, row.end - row.begin, job.hits);
  });
}

/// Casts tiles [begin, end). Three are in progress at a time: data that later steps of one need
/// (the corners of its triangles) are prefetched while the next is traced.
void cast_tiles(const Job& job, const Tiling& tiling, std::size_t begin, std::size_t end) {
  std::array<HitBatch, 3> batches;
  const bool misses_first = !tiling.has_runs() && !job.is_searched;
  if (misses_first) write_tile_misses(job, tiling, begin, end);
  for (std::size_t i = begin; i < end + 2; ++i) {
    if (i < end) {
      HitBatch& batch = batches[i % batches.size()];
      start(job, tiling, i, end, batch);
      if (!misses_first && !batch.block.is_run) write_tile_misses(job, tiling, i, i + 1);
    }
    if (i >= begin + 1 && i - 1 < end) {
      job.resolver.prefetch_corners(batches[(i - 1) % batches.size()].block, job.hit_columns);
    }
    if (i < begin + 2) continue;
    // Hits are written over the misses.
    job.resolver.write_batch(job.beams, job.hit_columns, batches[(i - 2) % batches.size()],
                             job.hits);
  }
}

/// Beams whose hits have ids, and wait until a batch is full. Three batches are in progress at a
/// time, as in cast_tiles().
class BeamQueue {
 public:
  BeamQueue(const Job& job, const HitColumnMask& hit_columns)
      : job_(job), hit_columns_(hit_columns) {}

  void add(std::size_t beam) {
    HitBatch& batch = batches_[started_ % batches_.size()];
    batch.beams.has_origins = !job_.beams.origins_m.empty();
    set(batch, used_, beam);
    if (++used_ == kLanes) advance();
  }

  void finish() {
    for (std::size_t i = 0; i < batches_.size(); ++i) advance();
  }

 private:
  void set(HitBatch& batch, unsigned lane, std::size_t beam) const {
    batch.block.beam[lane] = beam;
    batch.block.instance[lane] = job_.hits.instance[beam];
    batch.block.primitive[lane] = job_.hits.primitive[beam];
    batch.beams.direction.set(lane, job_.beams.directions[beam]);
    if (batch.beams.has_origins) batch.beams.origin_m.set(lane, job_.beams.origins_m[beam]);
  }

  /// Prepares the batch that is filled, and writes the oldest.
  void advance() {
    HitBatch& filled = batches_[started_ % batches_.size()];
    filled.block.mask = (1U << used_) - 1U;
    for (unsigned lane = used_; used_ > 0 && lane < kLanes; ++lane) {
      set(filled, lane, filled.block.beam[0]);
    }
    prepare_hits(job_, false, filled.block);
    const HitBatch& before = batches_[(started_ + batches_.size() - 1) % batches_.size()];
    job_.resolver.prefetch_corners(before.block, hit_columns_);
    HitBatch& oldest = batches_[++started_ % batches_.size()];
    job_.resolver.write_batch(job_.beams, hit_columns_, oldest, job_.hits);
    oldest.block.mask = 0;
    used_ = 0;
  }

  const Job& job_;
  HitColumnMask hit_columns_;
  std::array<HitBatch, 3> batches_;
  std::size_t started_ = 0;  ///< the last of them is being filled
  unsigned used_ = 0;        ///< lanes of it
};

/// Footprints on one triangle each that wait until a batch is full for the diffuse colours of
/// their other beams.
class ColourQueue {
 public:
  ColourQueue(const Job& job, std::size_t size) : job_(job), size_(size) {}

  void add(std::size_t first) {
    set(used_, first);
    if (++used_ == kLanes) finish();
  }

  void finish() {
    if (used_ == 0) return;
    const std::size_t first = batch_.block.beam[0];
    batch_.block.mask = (1U << used_) - 1U;
    for (; used_ < kLanes; ++used_) set(used_, first);
    prepare_hits(job_, false, batch_.block);
    job_.resolver.write_diffuse_behind(job_.beams, size_ - 1, batch_, job_.hits);
    used_ = 0;
  }

 private:
  void set(unsigned lane, std::size_t beam) {
    batch_.block.beam[lane] = beam;
    batch_.block.instance[lane] = job_.hits.instance[beam];
    batch_.block.primitive[lane] = job_.hits.primitive[beam];
  }

  const Job& job_;
  std::size_t size_;  ///< beams of a footprint
  HitBatch batch_;
  unsigned used_ = 0;  ///< lanes of it
};

bool is_one_triangle(const Hits& hits, std::size_t first, std::size_t count) {
  unsigned others = 0;
  for (std::size_t i = first + 1; i < first + count; ++i) {
    others |= static_cast<unsigned>(hits.instance[i] != hits.instance[first]) |
              static_cast<unsigned>(hits.primitive[i] != hits.primitive[first]);
  }
  return others == 0;
}

/// Adds a beam that hits something, or writes a miss.
void add_or_miss(const Job& job, std::size_t beam, BeamQueue& queue) {
  if (job.hits.instance[beam] != kInvalidId) return queue.add(beam);
  write_misses(job.hit_columns, beam, 1, job.hits);
}

/// Writes what is needed of the hits of footprints, whose ids are known.
void cast_footprints(const Job& job, const CastRequest& request, BeamRange range) {
  const std::size_t size = request.footprints.beams;
  BeamQueue all_columns(job, job.hit_columns);
  for (std::size_t first = range.begin; first < range.end; first += size) {
    add_or_miss(job, first, all_columns);
  }
  all_columns.finish();
  std::array<OtherHits, kTilesPerTask * kLanes> needed;
  const std::size_t footprints = (range.end - range.begin) / size;
  request.needed_of_others(range, {needed.data(), footprints});
  BeamQueue diffuse(job, {.diffuse = true});
  ColourQueue colours(job, size);
  for (std::size_t i = 0; i < footprints; ++i) {
    const std::size_t first = range.begin + i * size;
    if (needed[i] == OtherHits::ids) continue;
    if (needed[i] == OtherHits::diffuse && is_one_triangle(job.hits, first, size)) {
      colours.add(first);
      continue;
    }
    for (std::size_t beam = first + 1; beam < first + size; ++beam) {
      if (needed[i] == OtherHits::diffuse) diffuse.add(beam);
      if (needed[i] == OtherHits::all_columns) add_or_miss(job, beam, all_columns);
    }
  }
  all_columns.finish();
  diffuse.finish();
  colours.finish();
}

}  // namespace

TileCast::TileCast(CpuBase& base) : base_(base) {
  for (const Mesh& mesh : base.resolver.scene().meshes) mesh_boxes_.push_back(bounds(mesh));
}

bool TileCast::prepare(const CastRequest& request, Hits& hits) {
  Resolver& resolver = base_.resolver;
  check(request, resolver.scene());
  resize(hits, request.beams.size(), request.hit_columns);
  if (!any_instance_enabled(request, resolver.scene())) {
    write_misses(request.hit_columns, 0, request.beams.size(), hits);
    if (request.on_tile_done) request.on_tile_done({0, request.beams.size()});
    return false;
  }
  resolver.set_poses(request.world_from_sensor, request.world_from_instance);
  resolver.use_stored_planes(request.hit_columns, base_.thread_pool);
  base_.search.prepare(request);
  return true;
}

void TileCast::cast(const CastRequest& request, const HitFinder& finder, Hits& hits) {
  find_plane_points(request.beams, points_);
  const Job job{
      .beams = request.beams,
      .points = points_,
      .window = visible_window(base_.resolver, mesh_boxes_, request.instance_enabled, points_),
      .hit_columns = request.hit_columns,
      .resolver = base_.resolver,
      .search = base_.search.beams(),
      .is_searched = static_cast<bool>(finder.find),
      .hits = hits};
  const Tiling tiling(request.beams);
  ProgressCounter count(request.progress, tiling.size());
  // kLanes times the beams that are found at once fill as many tiles.
  const std::size_t group = finder.beams_at_once;
  const bool by_footprint =
      finder.find && request.needed_of_others && group == request.footprints.beams;
  const auto write_hits = [&](std::size_t begin, std::size_t end) {
    if (!by_footprint) return cast_tiles(job, tiling, begin, end);
    tiling.for_beam_rows(begin, end,
                         [&](BeamRange beams) { cast_footprints(job, request, beams); });
  };
  const std::size_t grain = std::max<std::size_t>(1, kTilesPerTask / group);
  base_.thread_pool.parallel_for(
      (tiling.size() + group - 1) / group, grain, [&](std::size_t begin, std::size_t end) {
        begin *= group;
        end = std::min(end * group, tiling.size());
        while (begin < end) {
          const std::size_t run_end = tiling.end_of_run(begin, end, grain * group);
          if (finder.find) tiling.for_beam_rows(begin, run_end, finder.find);
          if (!finder.finds_all) write_hits(begin, run_end);
          if (request.on_tile_done) tiling.for_beam_rows(begin, run_end, request.on_tile_done);
          count.add(run_end - begin);
          begin = run_end;
        }
      });
  count.finish();
}

}  // namespace glidar::rays
