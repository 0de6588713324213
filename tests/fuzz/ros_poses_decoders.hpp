// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

namespace glidar::testing {

/// Gives bytes to the decoders of what ROS 2 nodes send. The first byte selects the type: 0
/// transforms, 1 odometry, 2 a pose, 3 the clock; the rest is the message. True when it is valid.
/// Ends the program when a decoder breaks a promise.
bool try_ros_poses_decoders(std::span<const std::byte> bytes);

}  // namespace glidar::testing
