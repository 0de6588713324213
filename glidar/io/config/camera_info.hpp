// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/sensor/sensor.hpp>

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// Intrinsics and distortion of a camera as in ROS' sensor_msgs/CameraInfo, for OpenCV's convention
/// that the first pixel's centre is (0, 0).
struct CameraModel {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::string distortion_model;  ///< by ROS, otherwise by Kalibr (docs/files/images.md)
  std::vector<double> d;         ///< coefficients in the order of OpenCV or Kalibr
  std::array<double, 9> k{};     ///< row by row
  std::array<double, 9> r{};
  std::array<double, 12> p{};
};

/// Empty for optics other than a camera.
std::optional<CameraModel> camera_model(const Optics& optics);

/// Whether images of the sensor have ranges along the beams instead of depths: a camera with beams
/// that point back, where depths are negative.
bool images_have_range(const Sensor& sensor, const Beams& beams);

/// The camera model as JSON; null for other optics.
nlohmann::ordered_json camera_info_json(const Optics& optics);

}  // namespace glidar
