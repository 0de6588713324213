// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/sensor/depth_camera/point_spread.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

/// What the images of a depth camera are taken with.
struct ImagerSetup {
  const Imager& imager;
  const AmbientLight& illumination;
  std::uint32_t sub_rays = 1;  ///< each pixel is the mean of sub_rays x sub_rays rays
};

/// The images of a depth camera with everything that is the same for all frames.
struct PreparedImager {
  ImagerSetup setup;
  ImageSize size;
  double wavelength_m = 0.0;
  Beams rays;                   ///< sub_rays x sub_rays for each pixel, row by row
  std::vector<double> weights;  ///< of the rays around a pixel, see point_spread_weights()
  double electron_rate = 0.0;   ///< see electron_rate_per_radiance()
};

/// Of a sensor whose optics are a pinhole. Refers to what the setup refers to.
PreparedImager prepare_imager(const Sensor& sensor, const ImagerSetup& setup);

}  // namespace glidar
