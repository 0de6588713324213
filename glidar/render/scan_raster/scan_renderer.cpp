// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/scan_renderer.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/progress_counter.hpp>
#include <glidar/render/scan_raster/sector_exact_test.hpp>
#include <glidar/render/scan_raster/sector_writer.hpp>
#include <glidar/render/workspace_pool.hpp>

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

namespace glidar::scan_raster {

/// Workspace of one thread.
struct SectorScratch {
  std::vector<float> low;
  std::vector<float> high;
  std::vector<float> number;
  std::vector<float> farthest;
  std::vector<std::uint32_t> is_stale;
  std::vector<std::size_t> deferred_beams;

  SectorBuffer clear(const SectorTable& sector) {
    low.assign(sector.start().begin(), sector.start().end());
    high = low;
    number.assign(low.size(), std::bit_cast<float>(kNoSlotNumber));
    farthest.assign(sector.tile_start().begin(), sector.tile_start().end());
    is_stale.assign(farthest.size(), 0);
    return {low.data(), high.data(), number.data(), farthest.data(), is_stale.data()};
  }
};

namespace {

/// Inputs that all threads of a cast share.
struct Job {
  const CastRequest& request;
  const BeamGrid& grid;
  const rays::CastView cast;
  const InstanceSlots& slots;
  const Kernel& kernel;
  const HitTarget target;
  const bool has_bounds;  ///< otherwise all beams are cast as rays
};

void draw_sector(const Job& job, std::size_t index, SectorScratch& scratch) {
  const SectorTable& sector = job.grid.sectors()[index];
  const GridView view = job.grid.view(index);
  const SectorBuffer buffer = scratch.clear(sector);
  const SectorView beams = sector.view();
  scratch.deferred_beams.clear();
  SectorExactTest decision(job.cast, job.slots, sector, buffer, scratch.deferred_beams);
  for (const std::uint32_t instance : job.slots.order()) {
    Placement placement =
        make_placement(job.cast.trees, job.cast.resolver.view(instance), instance, sector);
    decision.set_instance(instance, placement);
    job.kernel.draw(view, beams, placement, buffer);
  }
  SectorWriter writer(job.target);
  writer.write_rows(sector, buffer, job.slots);
  writer.cast_rays(scratch.deferred_beams);
}

/// Casts a run of beams as rays.
void cast_run(const HitTarget& target, BeamRange run, SectorScratch& scratch) {
  write_misses(target.request.hit_columns, run.begin, run.end - run.begin, target.hits);
  scratch.deferred_beams.resize(run.end - run.begin);
  std::iota(scratch.deferred_beams.begin(), scratch.deferred_beams.end(), run.begin);
  SectorWriter(target).cast_rays(scratch.deferred_beams);
}

/// Calls visit(range) for the beams of every row of a sector.
template <class Visit>
void for_runs(const SectorTable& sector, const Visit& visit) {
  for (const SectorRow& row : sector.rows()) {
    if (row.count != 0) visit(BeamRange{row.first_beam, row.first_beam + row.count});
  }
}

void cast_sector(const Job& job, std::size_t index, SectorScratch& scratch) {
  if (job.has_bounds && job.grid.is_drawn(index)) return draw_sector(job, index, scratch);
  for_runs(job.grid.sectors()[index], [&](BeamRange run) { cast_run(job.target, run, scratch); });
}

}  // namespace

/// Workspaces that threads acquire and release; they are kept for later casts.
class ScanRenderer::SectorScratchPool : public WorkspacePool<SectorScratch> {};

ScanRenderer::ScanRenderer(std::shared_ptr<CpuBase> base)
    : base_(std::move(base)), scratch_pool_(std::make_unique<SectorScratchPool>()) {}
ScanRenderer::~ScanRenderer() = default;

const BeamGrid& ScanRenderer::grid_of(const Beams& beams) {
  grid_ = &grids_.of(beams, base_->thread_pool);
  return *grid_;
}

void ScanRenderer::cast(const CastRequest& request, Hits& hits) {
  check(request, base_->resolver.scene());
  const std::string& misfit = grid_of(request.beams).misfit();
  if (!misfit.empty()) {
    throw Error({.where = "raster renderer",
                 .found = misfit,
                 .allowed =
                     "a camera at rest, with a smooth lens or none, or beams in rows of equal "
                     "elevation and columns of equal azimuth",
                 .remedy = "use --renderer rays"});
  }
  if (!any_instance_enabled(request, base_->resolver.scene())) {
    resize(hits, request.beams.size(), request.hit_columns);
    write_misses(request.hit_columns, 0, request.beams.size(), hits);
    if (request.on_tile_done) request.on_tile_done({0, request.beams.size()});
    return;
  }
  base_->resolver.set_poses(request.world_from_sensor, request.world_from_instance);
  base_->resolver.use_stored_planes(request.hit_columns, base_->thread_pool);
  base_->search.prepare(request);
  cast_prepared(request, hits);
}

void ScanRenderer::cast_prepared(const CastRequest& request, Hits& hits) {
  resize(hits, request.beams.size(), request.hit_columns);
  const bool has_bounds = slots_.prepare(base_->search.trees(), base_->resolver);
  const Job job{.request = request,
                .grid = *grid_,
                .cast = {base_->search.trees(), base_->resolver, request},
                .slots = slots_,
                .kernel = kernel_,
                .target = {request, base_->resolver, base_->search.beams(), hits},
                .has_bounds = has_bounds};
  ProgressCounter count(request.progress, request.beams.size());
  const auto finish = [&](BeamRange run) {
    if (request.on_tile_done) request.on_tile_done(run);
    count.add(run.end - run.begin);
  };
  for_each(grid_->sectors().size(), [&](std::size_t i, SectorScratch& scratch) {
    cast_sector(job, i, scratch);
    for_runs(grid_->sectors()[i], finish);
  });
  for_each(grid_->other_rows().size(), [&](std::size_t i, SectorScratch& scratch) {
    const std::size_t first = std::size_t{grid_->other_rows()[i]} * request.beams.cols;
    const BeamRange row{first, first + request.beams.cols};
    cast_run(job.target, row, scratch);
    finish(row);
  });
  count.finish();
}

template <class Body>
void ScanRenderer::for_each(std::size_t pieces, const Body& body) {
  base_->thread_pool.parallel_for(pieces, 1, [&](std::size_t begin, std::size_t end) {
    std::unique_ptr<SectorScratch> scratch = scratch_pool_->acquire();
    for (std::size_t i = begin; i < end; ++i) body(i, *scratch);
    scratch_pool_->release(std::move(scratch));
  });
}

}  // namespace glidar::scan_raster
