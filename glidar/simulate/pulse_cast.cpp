// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/pulse_cast.hpp>

#include <glidar/simulate/flat_footprints.hpp>
#include <glidar/simulate/mirrors.hpp>

#include <algorithm>

namespace glidar {
namespace {

// For every thread: with their hits, some 90 bytes each, they fit into a core's own cache.
constexpr std::size_t kSubRaysPerBlock = std::size_t{1} << 14U;

/// Casts the sub-rays that hit a mirror once more.
void cast_mirrored(const Simulation& s) {
  SubRayWorkspace& memory = s.workspace.sub_rays;
  Beams& beams = memory.mirrored;
  beams.directions.clear();
  beams.origins_m.clear();
  beams.times_ns.clear();
  beams.boresight = s.fired->boresight;
  memory.mirrored_from.clear();
  const Hits& hits = memory.hits;
  for (std::size_t i = 0; i < hits.range_m.size(); ++i) {
    if (hits.instance[i] == kInvalidId || material_hit(s.scene, hits, i).mirror <= 0.0F) continue;
    add_reflected_beam(memory.beams, hits, i, beams);
    memory.mirrored_from.push_back(static_cast<std::uint32_t>(i));
  }
  beams.rows = 1;
  beams.cols = static_cast<std::uint32_t>(beams.directions.size());
  if (beams.directions.empty()) return;
  cast(s, cast_request(s, beams, kSignalFields), memory.mirrored_hits);
}

/// The bounds include the rounding of directions, whose lengths differ from 1 by up to 1e-6.
FootprintLayout layout_of(const std::vector<SubRay>& rays) {
  FootprintLayout layout{.beams = static_cast<std::uint32_t>(rays.size())};
  for (const SubRay& ray : rays) {
    layout.slope = std::max(layout.slope, ray.slope.norm());
    layout.radius_m = std::max(layout.radius_m, ray.offset_m.norm());
  }
  constexpr double kMargin = 1e-5;
  layout.slope += kMargin * layout.slope + 1e-12;
  layout.radius_m += kMargin * layout.radius_m;
  return layout;
}

OtherHits needed_of_others(FlatFootprint::Kind kind) {
  switch (kind) {
    case FlatFootprint::Kind::nothing:
    case FlatFootprint::Kind::plain:
      return OtherHits::ids;
    case FlatFootprint::Kind::coloured:
      return OtherHits::diffuse;
    default:
      return OtherHits::all_columns;
  }
}

/// Casts the sub-rays of a block of pulses.
void cast_block(const Simulation& s, BeamRange block) {
  SubRayWorkspace& memory = s.workspace.sub_rays;
  const PulseModel& model = *s.prepared.pulse_model;
  HitColumnMask hit_columns = s.hit_columns | kSignalFields;
  hit_columns.shading_normal = hit_columns.shading_normal || model.has_mirrors;
  hit_columns.normal = hit_columns.normal || model.sub_rays.size() > 1;
  memory.first_pulse = block.begin;
  expand_beams(model.sub_rays, *s.fired, block, s.renderer.thread_pool(), memory.beams);
  const auto fraction = [&](std::size_t pulse) {
    return static_cast<double>(pulse) / static_cast<double>(s.fired->firings());
  };
  CastRequest request = cast_request(s, memory.beams, hit_columns);
  request.footprints = layout_of(model.sub_rays);
  const FlatFootprints flat_footprints(s);
  memory.flat.assign(block.end - block.begin, {});
  const auto needed = [&](BeamRange beams, std::span<OtherHits> of_others) {
    const std::size_t size = model.sub_rays.size();
    flat_footprints.find({block.begin + beams.begin / size, block.begin + beams.end / size});
    for (std::size_t i = 0; i < of_others.size(); ++i) {
      of_others[i] = needed_of_others(memory.flat[beams.begin / size + i].kind);
    }
  };
  if (model.has_closed_form && !s.hit_columns.radial_velocity) {  // found for every sub-ray
    request.needed_of_others = FunctionRef<void(BeamRange, std::span<OtherHits>)>(needed);
  }
  request.progress = subrange(s.progress, fraction(block.begin), fraction(block.end));
  cast(s, request, memory.hits);
  memory.mirrored_from.clear();
  if (model.has_mirrors) cast_mirrored(s);
  memory.signals.resize(memory.beams.size());
  memory.velocities_m_s.resize(s.hit_columns.radial_velocity ? memory.beams.size() : 0);
}

}  // namespace

std::size_t first_sub_ray(const Simulation& s, std::size_t pulse) {
  return (pulse - s.workspace.sub_rays.first_pulse) * s.prepared.pulse_model->sub_rays.size();
}

std::size_t mirrored_beam(const SubRayWorkspace& memory, std::size_t sub_ray) {
  const std::vector<std::uint32_t>& from = memory.mirrored_from;
  return static_cast<std::size_t>(std::lower_bound(from.begin(), from.end(), sub_ray) -
                                  from.begin());
}

void cast_pulses(const Simulation& s, BeamRange pulses, FunctionRef<void(BeamRange)> on_tile_done) {
  resize(s.frame.ground_truth, s.fired->size(), s.hit_columns);
  s.frame.return_source.resize(s.fired->size());
  ThreadPool& threads = s.renderer.thread_pool();
  const std::size_t sub_rays = kSubRaysPerBlock * threads.threads();
  const std::size_t tasks = sub_rays / s.prepared.pulse_model->sub_rays.size() / kPulsesPerTask;
  const std::size_t step = std::max<std::size_t>(1, tasks) * kPulsesPerTask;
  for (std::size_t begin = pulses.begin; begin < pulses.end; begin += step) {
    const BeamRange block{begin, std::min(begin + step, pulses.end)};
    cast_block(s, block);
    const std::size_t runs = (block.end - block.begin + kPulsesPerTask - 1) / kPulsesPerTask;
    threads.parallel_for(runs, 1, [&](std::size_t first, std::size_t end) {
      on_tile_done({block.begin + first * kPulsesPerTask,
                    std::min(block.begin + end * kPulsesPerTask, block.end)});
    });
  }
}

}  // namespace glidar
