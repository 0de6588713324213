// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/message_types.hpp>
#include <glidar/io/ros/pose_message.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glidar::dds {

/// Maximum length of the name of a coordinate frame.
inline constexpr std::size_t kMaxFrameName_bytes = 255;
/// Maximum number of transforms in a message.
inline constexpr std::size_t kMaxTransforms = 10'000;

/// A pose as a message gives it.
struct FramedPose {
  ros::FramePair frames;  ///< child in parent; a PoseStamped has no child
  TimedPose pose;         ///< valid, with a normalised quaternion
};

/// The poses of a TFMessage, Odometry or PoseStamped, serialized as CDR. Throws Error unless it is
/// one message of this type, with frames that have names of a limited length, stamps within a
/// second, finite coordinates of at most 1e15 m and quaternions whose length is 1 within 0.001.
std::vector<FramedPose> decode_poses(const ros::MessageType& type,
                                     std::span<const std::byte> message);

/// The time of a Clock, ns. Throws Error unless it is one.
std::int64_t decode_clock(std::span<const std::byte> message);

}  // namespace glidar::dds
