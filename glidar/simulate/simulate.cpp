// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/simulate.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/motion/beam_poses.hpp>
#include <glidar/simulate/projector_occlusion.hpp>
#include <glidar/simulate/simulate_waveforms.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace glidar {
namespace {

/// Range and status of a run of beams from the truth.
void measure_range(const Limits& limits, const Beams& beams, BeamRange range, Frame& frame) {
  const bool sees_all = limits.near_m <= 0.0 && std::isinf(limits.far_m);
  const bool may_lack_beams = !beams.pinhole;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const double range_m = frame.ground_truth.range_m[i];
    frame.range_m[i] = range_m;
    if (!std::isnan(range_m)) {
      frame.status[i] = sees_all ? Status::hit : check_limits(limits, beams, i, range_m);
      if (frame.status[i] != Status::hit) frame.range_m[i] = kNaN;
    } else {
      const bool has_beam = !may_lack_beams || !std::isnan(beams.directions[i].x());
      frame.status[i] = has_beam ? Status::miss : Status::invalid_pixel;
    }
  }
}

/// Intensity, and what it takes away, of a run of beams from the truth.
void measure_light(const Setup& setup, BeamRange range, Frame& frame) {
  const Sensor& sensor = setup.sensor;
  if (sensor.pulse) {
    shade_lidar(*sensor.pulse, setup.scene, sensor.wavelength_m, range, frame);
  } else {
    shade_phong(sensor.light, range, frame);
  }
}

/// What its cast needs to be known of a frame under way.
struct Started {
  const Setup& setup;
  Frame& frame;
  const Beams& beams;   ///< as they are aimed
  HitFieldMask needed;  ///< also for light and noise

  /// Range and light of a run of beams whose hits are known.
  void operator()(BeamRange range) const {
    measure_range(setup.sensor.limits, beams, range, frame);
    measure_light(setup, range, frame);
  }
};

Started start(const Setup& setup, const HitFieldMask& fields, Frame& frame) {
  frame.rows = setup.beams.rows;
  frame.cols = setup.beams.cols;
  frame.frame_id = setup.beams.frame_id;
  sample_poses(setup.motion, frame);
  resize(frame, setup.beams.size());
  frame.return_source.clear();
  frame.sigma_m.clear();

  const Sensor& sensor = setup.sensor;
  HitFieldMask needed = fields;
  needed.shading = true;  // the light needs them
  needed.diffuse = needed.diffuse || sensor.pulse.has_value();
  needed.reflectance = needed.reflectance || !sensor.pulse;
  needed.normal = needed.normal || sensor.projector_origin_m.has_value();
  add_required_fields(sensor.noise, needed);
  return {setup, frame,
          perturbed_beams(sensor.noise, setup.beams, setup.renderer.thread_pool(), frame), needed};
}

/// Its cast; `started` must outlive it.
CastRequest request_of(const Started& started) {
  CastRequest request = request_of(started.setup, started.frame, started.beams, started.needed);
  request.on_tile_done = FunctionRef<void(BeamRange)>(started);
  request.progress = started.setup.progress;
  return request;
}

/// All that comes after the cast, before the noise.
void finish(const Started& started, const HitFieldMask& fields) {
  const auto& [setup, frame, beams, needed] = started;
  frame.picture.rgba.clear();
  if (setup.replace_returns) setup.replace_returns(setup, beams, frame);
  if (setup.sensor.projector_origin_m)
    occlude_from_projector(setup, *setup.sensor.projector_origin_m, beams, frame);
  deskew(timed_scene(setup, frame), setup.beams, beams, frame.deskewed);
  place_beams(setup.motion, setup.beams, fields.poses, setup.renderer.thread_pool(), frame);
}

void add_noise(const Setup& setup, Frame& frame) {
  apply_noise(setup.sensor.noise, 1.0 / setup.sensor.rate_hz, setup.beams,
              setup.renderer.thread_pool(), frame);
}

void check_batch(std::span<const Setup> setups, std::span<Frame> frames) {
  const auto require = [](bool holds, std::string found, const char* allowed) {
    if (holds) return;
    throw Error({.where = "batch", .found = std::move(found), .allowed = allowed, .remedy = ""});
  };
  require(
      setups.size() == frames.size(),
      std::to_string(setups.size()) + " setups for " + std::to_string(frames.size()) + " frames",
      "one setup per frame");
  require(std::all_of(setups.begin(), setups.end(),
                      [&](const Setup& s) { return &s.renderer == &setups.front().renderer; }),
          "several renderers", "one for all");
}

}  // namespace

void measure(const Setup& setup, const HitFieldMask& fields, Frame& frame) {
  const Started started = start(setup, fields, frame);
  if (needs_waveform(setup.sensor, setup.scene)) {
    simulate_waveforms(setup, started.needed, started.beams, frame);
  } else {
    cast_moving(timed_scene(setup, frame), request_of(started), frame.workspace,
                frame.ground_truth);
  }
  finish(started, fields);
}

void simulate(const Setup& setup, const HitFieldMask& fields, Frame& frame) {
  measure(setup, fields, frame);
  add_noise(setup, frame);
}

void simulate_batch(std::span<const Setup> setups, const HitFieldMask& fields,
                    std::span<Frame> frames) {
  check_batch(setups, frames);
  std::vector<Started> together;
  together.reserve(setups.size());  // requests refer to them
  std::vector<CastRequest> requests;
  std::vector<Hits*> hits;
  for (std::size_t i = 0; i < setups.size(); ++i) {
    const Setup& setup = setups[i];
    if (needs_waveform(setup.sensor, setup.scene) ||
        moves_during_frame(setup.motion, setup.beams)) {
      simulate(setup, fields, frames[i]);  // takes several casts
      continue;
    }
    together.push_back(start(setup, fields, frames[i]));
    requests.push_back(request_of(together.back()));
    hits.push_back(&frames[i].ground_truth);
  }
  if (together.empty()) return;
  setups.front().renderer.cast_batch(requests, hits);
  for (const Started& started : together) {
    finish(started, fields);
    add_noise(started.setup, started.frame);
  }
}

}  // namespace glidar
