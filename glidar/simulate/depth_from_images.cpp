// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/depth_from_images.hpp>

#include <glidar/simulate/stereo_measurement.hpp>
#include <glidar/simulate/structured_light_measurement.hpp>
#include <glidar/simulate/tof_measurement.hpp>

#include <variant>

namespace glidar {

void measure_depth(const Simulation& s) {
  std::visit([&](const auto& camera) { measure(s, camera); }, *s.prepared.depth_camera);
}

DepthTrace trace_depth(const Simulation& s, std::size_t pixel) {
  return std::visit([&](const auto& camera) -> DepthTrace { return trace_pixel(s, camera, pixel); },
                    *s.prepared.depth_camera);
}

}  // namespace glidar
