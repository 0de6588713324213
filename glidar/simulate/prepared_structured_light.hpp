// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/optics/projection.hpp>
#include <glidar/simulate/prepared_imager.hpp>

#include <optional>
#include <vector>

namespace glidar {

/// A structured-light camera with everything that is the same for all frames.
struct PreparedStructuredLight {
  const StructuredLightCamera& camera;
  StructuredLight setup;  ///< what decodes its images
  PreparedImager imager;
  PinholeProjection projection;           ///< of the projector
  Eigen::Vector3d projector_m;            ///< origin of the projector in the sensor frame
  double white_w_per_sr = 0.0;            ///< see white_intensity_w_per_sr()
  std::vector<std::vector<float>> lines;  ///< of each pattern, see projected_line()
};

PreparedStructuredLight prepare_structured_light(const StructuredLightCamera& camera,
                                                 const Sensor& sensor);

/// The pixel of the projector, whole numbers are centres, that lights what is at the end of a path
/// from it (in the sensor's axes); empty: none does.
std::optional<Eigen::Vector2d> projector_pixel(const PreparedStructuredLight& prepared,
                                               const Eigen::Vector3d& path);

}  // namespace glidar
