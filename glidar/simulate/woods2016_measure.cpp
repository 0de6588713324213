// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/woods2016_measure.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>

#include <cmath>

namespace glidar {
namespace {

constexpr std::size_t kPixelsPerTask = 4096;

/// What the picture has no room for.
void check(const Setup& setup, const Frame& frame) {
  const auto refuse_if = [](bool is_so, const char* found) {
    if (!is_so) return;
    throw Error({.where = "paper target",
                 .found = found,
                 .allowed = "the paper's light, and beams that fire together where they are aimed",
                 .remedy = "leave --quantized-framebuffer out"});
  };
  refuse_if(setup.sensor.pulse.has_value(), "pulsed light");
  refuse_if(!setup.beams.times_ns.empty(), "beams that fire one by one");
  refuse_if(!frame.workspace.aimed.directions.empty(), "errors of pointing");
}

}  // namespace

void measure_woods2016(const Setup& setup, const Woods2016Target& paper, Frame& frame) {
  check(setup, frame);
  paper.camera.draw({.beams = setup.beams,
                     .world_from_sensor = frame.world_from_sensor,
                     .world_from_instance = frame.world_from_instance,
                     .cull_back_faces = setup.sensor.cull_back_faces},
                    setup.sensor.light, paper.planes, frame.picture);
  const auto read = [&](std::size_t begin, std::size_t end) {
    decode(frame.picture, setup.beams, {begin, end}, frame.range_m, frame.intensity);
    for (std::size_t i = begin; i < end; ++i) {
      const bool is_seen = !std::isnan(frame.range_m[i]);
      frame.status[i] = is_seen
                            ? check_limits(setup.sensor.limits, setup.beams, i, frame.range_m[i])
                            : Status::miss;
      if (frame.status[i] == Status::hit) continue;
      frame.range_m[i] = kNaN;
      frame.intensity[i] = 0.0F;
    }
  };
  setup.renderer.thread_pool().parallel_for(setup.beams.size(), kPixelsPerTask, read);
}

}  // namespace glidar
