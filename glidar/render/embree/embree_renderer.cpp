// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/embree/embree_renderer.hpp>

#include <glidar/core/work_count.hpp>
#include <glidar/render/embree/embree_world.hpp>
#include <glidar/render/embree/settle.hpp>
#include <glidar/render/embree/tiles.hpp>
#include <glidar/render/grid_window.hpp>
#include <glidar/render/plane_points.hpp>
#include <glidar/render/resolve.hpp>

#include <array>
#include <bit>
#include <memory>
#include <utility>

namespace glidar {
namespace {

/// What one cast hands to every tile.
struct Job {
  const Beams& beams;
  const PlanePoints& points;
  GridWindow window;  ///< beams outside of it miss
  const HitFields& fields;
  const Resolver& resolver;
  const ExactSearch& search;
  const embree::Probe& probe;
  bool cull_back_faces;
  bool has_wide_packets;
  bool with_corners;  ///< the fields need those of triangles
  Hits& hits;
};

/// All that is worked out for one tile.
struct TileWork {
  HitBlock block;
  BeamBlock beams;
  Lanes<int> valid;  ///< -1: the lane has a beam
  embree::RayHits rays;
  ExactBlock exact;
};

/// Collects the beams of a tile that lies wholly in a pinhole's grid.
void gather_pinhole(const PlanePoints& points, const embree::Tile& tile, TileWork& work) {
  const std::uint32_t column_mask = (1U << tile.width_shift) - 1U;
  Lanes<double> x;
  Lanes<double> y;
  const std::size_t first = tile.beam(0);
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    const std::uint32_t row = lane >> tile.width_shift;
    const std::uint32_t col = lane & column_mask;
    x[lane] = points.x[tile.first_col + col];
    y[lane] = points.y[tile.first_row + row];
    work.block.beam[lane] = first + std::size_t{row} * tile.cols + col;
    work.valid[lane] = -1;
  }
  directions_through(x, y, work.beams.direction);
}

/// Collects the tile's beams; lanes beyond the grid's border repeat the first and are not valid.
void gather_beams(const Beams& beams, const embree::Tile& tile, TileWork& work) {
  const bool whole = tile.is_whole(kLanes);
  const std::size_t first = tile.beam(0);
  const std::uint32_t column_mask = (1U << tile.width_shift) - 1U;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    const std::size_t beam =
        first + std::size_t{lane >> tile.width_shift} * tile.cols + (lane & column_mask);
    const bool inside = whole || tile.beam(lane) != embree::Tile::kOutside;
    work.valid[lane] = inside ? -1 : 0;
    work.block.beam[lane] = inside ? beam : first;
    work.beams.direction.set(lane, beams.directions[work.block.beam[lane]]);
  }
  work.beams.has_origins = !beams.origins_m.empty();
  if (!work.beams.has_origins) return;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    work.beams.origin_m.set(lane, beams.origins_m[work.block.beam[lane]]);
  }
}

/// Asks the memory for a tile's beams ahead of time.
void prefetch(const Beams& beams, const embree::Tile& tile) {
  for (unsigned lane = 0; lane < kLanes; lane += 2) {  // two directions and a half per cache line
    const std::size_t beam = tile.beam(lane);
    if (beam == embree::Tile::kOutside) continue;
    __builtin_prefetch(&beams.directions[beam]);
    if (!beams.origins_m.empty()) __builtin_prefetch(&beams.origins_m[beam]);
  }
}

/// The triangle to tell for one found, see Resolver::told.
std::uint32_t told(const Job& job, std::uint32_t instance, std::uint32_t primitive) {
  return job.cull_back_faces ? primitive : job.resolver.told(instance, primitive);
}

/// Traces the beams: sets the block's mask and, per lane, instance and primitive.
void trace(const Job& job, TileWork& work) {
  job.probe.set_rays(work.block.beam, work.beams, work.valid, work.rays);
  embree::FilterContext context = job.probe.context();
  embree::intersect(job.probe.space().scene, context.embree, job.has_wide_packets, work.valid,
                    work.rays);
  const RTCHit16& hit = work.rays.hit;
  work.block.mask = 0;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    const bool is_hit = work.valid[lane] != 0 && hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
    work.block.mask |= static_cast<std::uint32_t>(is_hit) << lane;
    const unsigned instance = hit.instID[0][lane];
    work.block.instance[lane] = instance == RTC_INVALID_GEOMETRY_ID ? 0U : instance;
    if (!is_hit) continue;
    work.block.primitive[lane] = told(job, work.block.instance[lane], hit.primID[lane]);
    job.resolver.prefetch(work.block, lane, job.with_corners);
    job.probe.prefetch(work.block, lane);
  }
}

/// Puts these lanes right by an exact test; true when that changed the block.
template <class Test>
bool correct(const Job& job, std::uint32_t lanes, const Test& test, HitBlock& block) {
  bool changed = false;
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(lanes));
    const Found before{block.instance[lane], block.primitive[lane]};
    const Found after = test(block.beam[lane], before);
    if (after.instance == before.instance && after.primitive == before.primitive) continue;
    changed = true;
    if (after.instance == kNoHit) {
      block.mask &= ~(1U << lane);
      continue;
    }
    block.instance[lane] = after.instance;
    block.primitive[lane] = told(job, after.instance, after.primitive);
  }
  return changed;
}

/// Decides between surfaces of several instances that lie closer together than single precision
/// resolves.
void choose_among_instances(const Job& job, TileWork& work) {
  const std::uint32_t lanes = job.search.overlapping(work.block, work.beams, work.exact);
  const auto choose = [&](std::size_t beam, const Found& found) {
    return job.search.nearest_around(beam, found);
  };
  if (lanes != 0 && correct(job, lanes, choose, work.block)) {
    job.resolver.measure(work.beams, work.block, work.exact);
  }
}

/// Writes the hits of a traced tile over the misses that stand there.
void finish(const Job& job, TileWork& work) {
  HitBlock& block = work.block;
  if (block.mask != 0) {
    job.resolver.measure(work.beams, block, work.exact);
    const std::uint32_t doubtful = job.probe.doubtful(block, work.exact, work.rays);
    const auto settle = [&](std::size_t beam, const Found& found) {
      return job.probe.settle(beam, found);
    };
    if (doubtful != 0 && correct(job, doubtful, settle, block) && block.mask != 0) {
      job.resolver.measure(work.beams, block, work.exact);
    }
  }
  if (block.mask != 0 && job.search.has_overlaps()) choose_among_instances(job, work);
  if (block.mask != 0) job.resolver.write(job.beams, job.fields, block, work.exact, job.hits);
}

/// Collects and traces the beams of tile i.
void start(const Job& job, const embree::Tiling& tiling, std::size_t i, std::size_t end,
           TileWork& work) {
  const embree::Tile tile = tiling.tile(i);
  if (!job.window.meets(tile.window(kLanes))) {
    work.block.mask = 0;
    return;
  }
  if (!job.points.x.empty() && tile.is_whole(kLanes)) {
    gather_pinhole(job.points, tile, work);
  } else {
    gather_beams(job.beams, tile, work);
    if (i + 1 < end) prefetch(job.beams, tiling.tile(i + 1));
  }
  trace(job, work);
}

/// Casts tiles [begin, end). Three are under way at a time, so that what the later steps of one
/// read from memory (planes and corners of its triangles) comes while the next is traced.
void cast_tiles(const Job& job, const embree::Tiling& tiling, std::size_t begin, std::size_t end) {
  std::array<TileWork, 3> ring;
  tiling.for_beam_rows(begin, end, [&](BeamRange row) {
    write_misses(job.fields, row.begin, row.end - row.begin, job.hits);
  });
  for (std::size_t i = begin; i < end + 2; ++i) {
    if (i < end) start(job, tiling, i, end, ring[i % ring.size()]);
    if (i >= begin + 1 && i - 1 < end) {
      job.resolver.prefetch_corners(ring[(i - 1) % ring.size()].block, job.fields);
    }
    if (i >= begin + 2) finish(job, ring[(i - 2) % ring.size()]);
  }
}

class EmbreeRenderer final : public Renderer {
 public:
  explicit EmbreeRenderer(std::shared_ptr<CpuBase> base) : base_(std::move(base)) {
    workers().execute([&] { world_ = std::make_unique<embree::World>(base_->resolver.scene()); });
  }

  [[nodiscard]] std::string_view name() const override { return "embree"; }
  [[nodiscard]] Workers& workers() override { return base_->workers; }

  void cast(const CastRequest& request, Hits& hits) override {
    Resolver& resolver = base_->resolver;
    check(request, resolver.scene());
    resize(hits, request.beams.size(), request.fields);
    if (!is_anything_present(request, resolver.scene())) {
      write_misses(request.fields, 0, request.beams.size(), hits);
      if (request.then) request.then({0, request.beams.size()});
      return;
    }
    resolver.set_poses(request.world_from_sensor, request.world_from_instance);
    workers().execute([&] {
      if (request.cull_back_faces) world_->filter_everything();
      world_->place(request);
    });
    base_->search.prepare(request);
    const embree::Probe probe(*world_, resolver, base_->search, request);
    find_plane_points(request.beams, points_);
    const Job job{.beams = request.beams,
                  .points = points_,
                  .window = window_on(resolver, world_->mesh_boxes(), request.present, points_),
                  .fields = request.fields,
                  .resolver = resolver,
                  .search = base_->search,
                  .probe = probe,
                  .cull_back_faces = request.cull_back_faces,
                  .has_wide_packets = world_->has_wide_packets(),
                  .with_corners = needs_corners(request.fields),
                  .hits = hits};
    const embree::Tiling tiling(request.beams);
    WorkCount count(request.progress, tiling.size());
    workers().for_ranges(tiling.size(), kTilesPerTask, [&](std::size_t begin, std::size_t end) {
      while (begin < end) {
        const std::size_t run_end = tiling.end_of_run(begin, end, kTilesPerTask);
        cast_tiles(job, tiling, begin, run_end);
        if (request.then) tiling.for_beam_rows(begin, run_end, request.then);
        count.add(run_end - begin);
        begin = run_end;
      }
    });
    count.finish();
  }

 private:
  // About 50 microseconds of work, and its hits fit into a core's own cache.
  static constexpr std::size_t kTilesPerTask = 64;

  std::shared_ptr<CpuBase> base_;
  PlanePoints points_;
  std::unique_ptr<embree::World> world_;
};

}  // namespace

std::unique_ptr<Renderer> make_embree_renderer(const Scene& scene, const RendererOptions& options) {
  return make_embree_renderer(std::make_shared<CpuBase>(scene, options.threads));
}

std::unique_ptr<Renderer> make_embree_renderer(std::shared_ptr<CpuBase> base) {
  return std::make_unique<EmbreeRenderer>(std::move(base));
}

}  // namespace glidar
