// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/sensor/sensor.hpp>

#include <nlohmann/json.hpp>

namespace glidar {

/// Intrinsics and distortion of a camera as in ROS' sensor_msgs/CameraInfo, for OpenCV's convention
/// that the first pixel's centre is (0, 0); null for other optics.
nlohmann::ordered_json camera_info_json(const Optics& optics);

}  // namespace glidar
