// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/woods2016/framebuffer.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>

#include <cmath>
#include <limits>

namespace glidar {
namespace {

constexpr std::size_t kPixelsPerTask = 4096;

/// Throws Error for sensors whose measurement the framebuffer cannot represent.
void check_representable(const CastContext& cast) {
  const auto refuse_if = [](bool is_so, const char* found) {
    if (!is_so) return;
    throw Error({.where = "--quantized-framebuffer",
                 .found = found,
                 .allowed = "sensors without lidar_equation, firing times and pointing noise",
                 .remedy = "leave --quantized-framebuffer out"});
  };
  refuse_if(cast.sensor.lidar_equation.has_value(), "a pulsed sensor");
  refuse_if(!cast.beams.times_ns.empty(), "beams with firing times");
  refuse_if(&cast.fired != &cast.beams, "pointing noise");
}

/// Status of the decoded ranges of a tile; ranges outside the limits are removed.
void classify_decoded(const CastContext& cast, BeamRange tile, Frame& frame) {
  for (std::size_t i = tile.begin; i < tile.end; ++i) {
    const bool is_visible = !std::isnan(frame.range_m[i]);
    frame.status[i] = is_visible ? check_limits(cast.sensor.limits, cast.beams, i, frame.range_m[i])
                                 : Status::miss;
    if (frame.status[i] == Status::hit) continue;
    frame.range_m[i] = kNaN;
    frame.intensity[i] = 0.0F;
  }
}

}  // namespace

void decode_framebuffer(const Woods2016Framebuffer& framebuffer, const Beams& beams,
                        BeamRange range, std::vector<double>& range_m,
                        std::vector<float>& intensity) {
  constexpr double kByteSteps = 65536.0;
  const double step_m = (framebuffer.far_m - framebuffer.near_m) / kByteSteps;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const std::uint8_t* rgba = &framebuffer.rgba[4 * i];
    if (rgba[3] == 0) {
      range_m[i] = std::numeric_limits<double>::quiet_NaN();
      intensity[i] = 0.0F;
      continue;
    }
    // The inverse of equations (6) to (8). They round D down, so the middle of its step is the best
    // estimate.
    const double steps = 256.0 * rgba[1] + rgba[2] + 0.5;
    const double depth = framebuffer.near_m + steps * step_m;
    range_m[i] = depth / beams.directions[i].z();
    intensity[i] = static_cast<float>(rgba[0]) / 255.0F;
  }
}

ReturnReplacement woods2016_measurement(Woods2016Camera& camera,
                                        std::optional<Woods2016DepthPlanes> planes) {
  return [&camera, planes](const CastContext& cast, Frame& frame) {
    check_representable(cast);
    camera.draw({.beams = cast.beams,
                 .world_from_sensor = frame.world_from_sensor,
                 .world_from_instance = frame.world_from_instance,
                 .cull_back_faces = cast.sensor.cull_back_faces,
                 .instance_enabled = cast.instance_enabled},
                cast.sensor.light, planes, frame.framebuffer);
    const auto decode = [&](std::size_t begin, std::size_t end) {
      decode_framebuffer(frame.framebuffer, cast.beams, {begin, end}, frame.range_m,
                         frame.intensity);
      classify_decoded(cast, {begin, end}, frame);
    };
    cast.thread_pool.parallel_for(cast.beams.size(), kPixelsPerTask, decode);
  };
}

}  // namespace glidar
