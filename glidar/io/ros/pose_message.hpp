// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/file_text.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/io/ros/messages.hpp>
#include <glidar/motion/timed_poses.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace glidar::ros {

/// The names of two coordinate frames: `child` has a pose in `parent`.
struct FramePair {
  std::string parent;
  std::string child;
  bool operator==(const FramePair&) const = default;
};

/// The name of a coordinate frame without the leading slash that ROS 1 had.
std::string received_frame(const FileText& name);

/// A velocity in the axes of the moving body.
struct BodyTwist {
  Eigen::Vector3d linear_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_rad_s = Eigen::Vector3d::Zero();
};

TransformStamped to_transform(const Pose& parent_from_child, const FramePair& frames,
                              std::int64_t t_ns);
PoseStamped to_pose_stamped(const Pose& parent_from_body, const std::string& parent,
                            std::int64_t t_ns);
/// Without a twist, its velocities are 0 and the first element of its covariance is -1, as
/// sensor_msgs/Imu marks values that are unknown.
Odometry to_odometry(const Pose& parent_from_child, const std::optional<BodyTwist>& twist,
                     const FramePair& frames, std::int64_t t_ns);
Clock to_clock(std::int64_t t_ns);

/// The mean velocity from one pose of a body to its next, `seconds` later: the logarithm of the
/// displacement, exact for a constant twist. Lynch and Park, "Modern Robotics" (2017), 3.3.3.2.
BodyTwist mean_twist(const Pose& before, const Pose& after, double seconds);

/// Poses of messages, as received: the quaternion may have any length.
TimedPose timed_pose(const TransformStamped& transform);
TimedPose timed_pose(const PoseStamped& pose);
TimedPose timed_pose(const Odometry& odometry);

}  // namespace glidar::ros
