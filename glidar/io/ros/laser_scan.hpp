// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/cloud_message.hpp>

#include <cstdint>
#include <string>

namespace glidar::ros {

/// The beams of one ring as a scan in the plane of the sensor's axes ahead and left: angles grow
/// counter-clockwise, those of a whole turn from -pi on, and ranges are distances in that plane.
/// The stamp is the time of the first firing, and time_increment is positive, as of all drivers,
/// also of scanners that turn clockwise, whose greatest angles fire first. REP-117: +inf without a
/// return, -inf for surfaces that are too near, NaN for invalid measurements. Throws Error when the
/// ring has fewer than two beams or its angles are not equally spaced.
/// `quarter_turns` of the axes: see quarter_turned().
LaserScan laser_scan(const CloudSource& source, std::uint16_t ring,
                     const std::string& frame_id = {}, int quarter_turns = 0);

// Scans as the drivers of manufacturers make them: docs/drivers.md.

/// The nearly level ring in bins of 0.007 rad: ros-drivers/velodyne (04a7ca7),
/// velodyne_laserscan.cpp.
LaserScan velodyne_scan(const CloudSource& source, std::int64_t stamp_ns,
                        const std::string& frame_id);

/// The highest row, in reverse: ouster-lidar/ouster-ros (f5c4ef8), os_ros.cpp.
LaserScan ouster_scan(const CloudSource& source, std::int64_t stamp_ns,
                      const std::string& frame_id);

/// All returns in bins of equal angles, in reverse: Slamtec/sllidar_ros2 (3430009),
/// sllidar_node.cpp with angle_compensate.
LaserScan rplidar_scan(const CloudSource& source, std::int64_t stamp_ns,
                       const std::string& frame_id);

}  // namespace glidar::ros
