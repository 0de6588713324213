// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/cloud_message.hpp>

#include <cstdint>
#include <string>

namespace glidar::ros {

/// The beams of one ring as a scan in the plane of the sensor's axes ahead and left: angles grow
/// counter-clockwise, and ranges are distances in that plane. The stamp is the firing time of the
/// first angle; time_increment is negative when the sensor turns clockwise. REP-117: +inf
/// without a return, -inf for surfaces that are too near, NaN for invalid measurements. Throws
/// Error when the ring has fewer than two beams or its angles are not equally spaced.
LaserScan laser_scan(const CloudSource& source, std::uint16_t ring,
                     const std::string& frame_id = {});

}  // namespace glidar::ros
