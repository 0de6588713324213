// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/pose_message.hpp>

#include <glidar/math/portable.hpp>
#include <glidar/motion/rotation_vector.hpp>

#include <cmath>

namespace glidar::ros {
namespace {

Vector3 to_vector(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// With w >= 0, so that equal rotations have equal bytes.
Quaternion orientation_of(const Pose& pose) {
  const PoseVector numbers = to_xyz_wxyz(pose);
  return {numbers[4], numbers[5], numbers[6], numbers[3]};
}

Header stamped(const std::string& frame_id, std::int64_t t_ns) {
  return {.stamp = time_from_ns(t_ns), .frame_id = frame_id};
}

TimedPose received(const Header& header, const Vector3& position, const Quaternion& q) {
  return {.t_ns = to_ns(header.stamp),
          .position_m = {position.x, position.y, position.z},
          .orientation = Eigen::Quaterniond(q.w, q.x, q.y, q.z)};
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

}  // namespace

TransformStamped to_transform(const Pose& parent_from_child, const FramePair& frames,
                              std::int64_t t_ns) {
  return {stamped(frames.parent, t_ns),
          frames.child,
          {to_vector(parent_from_child.translation()), orientation_of(parent_from_child)}};
}

PoseStamped to_pose_stamped(const Pose& parent_from_body, const std::string& parent,
                            std::int64_t t_ns) {
  return {stamped(parent, t_ns),
          {to_vector(parent_from_body.translation()), orientation_of(parent_from_body)}};
}

Odometry to_odometry(const Pose& parent_from_child, const std::optional<BodyTwist>& twist,
                     const FramePair& frames, std::int64_t t_ns) {
  Odometry odometry;
  odometry.header = stamped(frames.parent, t_ns);
  odometry.child_frame_id = frames.child;
  odometry.pose = {to_vector(parent_from_child.translation()), orientation_of(parent_from_child)};
  if (twist) {
    odometry.linear_velocity = to_vector(twist->linear_m_s);
    odometry.angular_velocity = to_vector(twist->angular_rad_s);
  } else {
    odometry.twist_covariance[0] = -1.0;  // unknown, as in sensor_msgs/Imu
  }
  return odometry;
}

Clock to_clock(std::int64_t t_ns) {
  return {time_from_ns(t_ns)};
}

BodyTwist mean_twist(const Pose& before, const Pose& after, double seconds) {
  const Pose moved = before.inverse() * after;
  const Eigen::Vector3d turned = rotation_between(Eigen::Quaterniond::Identity(),
                                                  Eigen::Quaterniond(moved.linear()).normalized());
  const double angle = turned.norm();
  // The inverse of the left Jacobian; 1/12 is its limit for small angles.
  constexpr double kSmall = 1e-4;
  const double factor =
      angle < kSmall ? 1.0 / 12.0
                     : (1.0 - 0.5 * angle * portable_sin(angle) / (1.0 - portable_cos(angle))) /
                           (angle * angle);
  const Eigen::Matrix3d cross = cross_matrix(turned);
  const Eigen::Vector3d moved_m = moved.translation() - 0.5 * cross * moved.translation() +
                                  factor * cross * cross * moved.translation();
  return {moved_m / seconds, turned / seconds};
}

std::string received_frame(const FileText& name) {
  const std::string& bytes = name.bytes();
  return bytes.starts_with('/') ? bytes.substr(1) : bytes;
}

TimedPose timed_pose(const TransformStamped& transform) {
  return received(transform.header, transform.transform.translation, transform.transform.rotation);
}

TimedPose timed_pose(const PoseStamped& pose) {
  return received(pose.header, pose.pose.position, pose.pose.orientation);
}

TimedPose timed_pose(const Odometry& odometry) {
  return received(odometry.header, odometry.pose.position, odometry.pose.orientation);
}

}  // namespace glidar::ros
