// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/simulation.hpp>

#include <glidar/math/constants.hpp>

#include <cmath>

namespace glidar {

TimedScene timed_scene(const Simulation& s) {
  return {s.renderer, s.scene, s.motion, s.frame.stamp_ns};
}

std::uint32_t exposure_time_ns(std::size_t index, double interval_s) {
  const double time_ns = static_cast<double>(index) * interval_s * kSecond_ns;
  return static_cast<std::uint32_t>(std::floor(time_ns + 0.5));
}

CastRequest cast_request(const Simulation& s, const Beams& beams,
                         const HitColumnMask& hit_columns) {
  return {.beams = beams,
          .world_from_sensor = s.frame.world_from_sensor,
          .world_from_instance = s.frame.world_from_instance,
          .hit_columns = hit_columns,
          .cull_back_faces = s.prepared.sensor.cull_back_faces,
          .instance_enabled = s.instance_enabled};
}

void cast(const Simulation& s, const CastRequest& request, Hits& hits) {
  if (s.is_moving) {
    cast_moving(timed_scene(s), request, s.workspace.moving_cast, hits);
  } else {
    s.renderer.cast(request, hits);
  }
}

}  // namespace glidar
