// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate.hpp>

#include <glidar/motion/beam_poses.hpp>
#include <glidar/paper_measure.hpp>
#include <glidar/pulse_cast.hpp>
#include <glidar/shadow_cast.hpp>

#include <cmath>
#include <limits>

namespace glidar {
namespace {

constexpr double kNoRange = std::numeric_limits<double>::quiet_NaN();

/// Range and status of a run of beams from the truth.
void measure_range(const Limits& limits, const Beams& beams, BeamRange range, Frame& frame) {
  const bool sees_all = limits.near_m <= 0.0 && std::isinf(limits.far_m);
  const bool may_lack_beams = !beams.pinhole;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const double range_m = frame.truth.range_m[i];
    frame.range_m[i] = range_m;
    if (!std::isnan(range_m)) {
      frame.status[i] = sees_all ? Status::hit : judge(limits, beams, i, range_m);
      if (frame.status[i] != Status::hit) frame.range_m[i] = kNoRange;
    } else {
      const bool has_beam = !may_lack_beams || !std::isnan(beams.directions[i].x());
      frame.status[i] = has_beam ? Status::miss : Status::no_beam;
    }
  }
}

/// Intensity, and what it takes away, of a run of beams from the truth.
void measure_light(const Setup& setup, BeamRange range, Frame& frame) {
  const Sensor& sensor = setup.sensor;
  if (sensor.pulse) {
    measure_signal(*sensor.pulse, setup.scene, sensor.wavelength_m, range, frame);
  } else {
    measure_intensity(sensor.light, range, frame);
  }
}

}  // namespace

void measure(const Setup& setup, const HitFields& fields, Frame& frame) {
  frame.rows = setup.beams.rows;
  frame.cols = setup.beams.cols;
  frame.frame_id = setup.beams.frame_id;
  place(setup.motion, frame);
  resize(frame, setup.beams.size());

  const Sensor& sensor = setup.sensor;
  Workers& workers = setup.renderer.workers();
  const Beams& beams = aimed_beams(sensor.noise, setup.beams, workers, frame);

  HitFields needed = fields;
  needed.shading = true;  // the light needs them
  needed.reflectance = true;
  needed.normal = needed.normal || sensor.projector_m.has_value();
  add_needs(sensor.noise, needed);
  const World world = world_of(setup, frame);
  const auto measure_run = [&](BeamRange range) {
    measure_range(sensor.limits, beams, range, frame);
    measure_light(setup, range, frame);
  };
  frame.cause.clear();
  frame.sigma_m.clear();
  if (has_echoes(sensor, setup.scene)) {
    measure_pulses(setup, needed, beams, frame);
  } else {
    CastRequest request = request_of(setup, frame, beams, needed);
    request.then = FunctionRef<void(BeamRange)>(measure_run);
    request.progress = setup.progress;
    cast_moving(world, request, frame.scratch, frame.truth);
  }
  frame.picture.rgba.clear();
  if (setup.paper) measure_paper(setup, *setup.paper, frame);
  if (sensor.projector_m) cast_shadows(setup, *sensor.projector_m, beams, frame);
  deskew(world, setup.beams, beams, frame.deskewed);
  place_beams(setup.motion, setup.beams, fields.poses, workers, frame);
}

void simulate(const Setup& setup, const HitFields& fields, Frame& frame) {
  measure(setup, fields, frame);
  apply_noise(setup.sensor.noise, 1.0 / setup.sensor.rate_hz, setup.beams, setup.renderer.workers(),
              frame);
}

}  // namespace glidar
