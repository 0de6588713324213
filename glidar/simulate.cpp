// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate.hpp>

#include <cmath>

namespace glidar {
namespace {

constexpr std::size_t kBeamsPerTask = 4096;  // some 50 microseconds of work

/// What the sensor says of a surface at this true range.
Status judge(const DepthLimits& limits, const Beams& beams, std::size_t beam, double range_m) {
  const double depth = depth_m(beams, beam, range_m);
  if (depth < limits.near_m) return Status::too_near;
  if (depth > limits.far_m) return Status::too_far;
  return Status::hit;
}

/// Range and status of beams [begin, end) from the truth.
void measure_range(const DepthLimits& limits, const Beams& beams, BeamRange range, Frame& frame) {
  const bool sees_all = limits.near_m <= 0.0 && std::isinf(limits.far_m);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const double range_m = frame.truth.range_m[i];
    Status status = Status::miss;
    if (!std::isnan(range_m)) {
      status = sees_all ? Status::hit : judge(limits, beams, i, range_m);
    } else if (std::isnan(beams.directions[i].x())) {
      status = Status::no_beam;
    }
    frame.status[i] = status;
    frame.range_m[i] = status == Status::hit ? range_m : std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

void simulate(const Setup& setup, const HitFields& fields, Frame& frame) {
  frame.rows = setup.beams.rows;
  frame.cols = setup.beams.cols;
  frame.frame_id = setup.beams.frame_id;
  place(setup.motion, frame);

  HitFields needed = fields;
  needed.shading_normal = true;  // the light needs them
  needed.reflectance = true;
  setup.renderer.cast({.beams = setup.beams,
                       .world_from_sensor = frame.world_from_sensor,
                       .world_from_instance = frame.world_from_instance,
                       .fields = needed,
                       .cull_back_faces = setup.sensor.cull_back_faces},
                      frame.truth);

  resize(frame, setup.beams.size());
  setup.renderer.workers().for_ranges(
      setup.beams.size(), kBeamsPerTask, [&](std::size_t begin, std::size_t end) {
        const BeamRange range{begin, end};
        measure_range(setup.sensor.limits, setup.beams, range, frame);
        measure_intensity(setup.sensor.light, setup.beams, range, frame);
      });
}

}  // namespace glidar
