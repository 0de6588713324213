// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/infrared_shading.hpp>
#include <glidar/simulate/simulation.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// A camera with the sensor's optics and axes, and its projector.
struct InfraredView {
  const PreparedImager& imager;
  ProjectorIntensity projector;
  Eigen::Vector3d projector_m;                      ///< its origin, in the sensor frame
  Eigen::Vector3d eye_m = Eigen::Vector3d::Zero();  ///< that of the camera
  std::uint32_t time_ns = 0;                        ///< since the start of the frame
};

/// Casts the rays of an image and their shadows. Electrons per second of each pixel by the
/// projector's light and by all other light; the radiances of the rays are in
/// Simulation::workspace.
void render_infrared(const Simulation& s, const InfraredView& view, ElectronRates& rates);

/// Electrons per second of each pixel for a radiance of each ray: point spread, and the fall of the
/// light with cos^4 of the angle from the axis. 0 for pixels without a ray.
void find_electron_rates(const Simulation& s, const PreparedImager& imager,
                         std::span<const float> radiance, std::vector<float>& per_s);

}  // namespace glidar
