// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ros_poses_decoders.hpp"

#include <glidar/core/error.hpp>
#include <glidar/link/dds/pose_decoder.hpp>

#include "demand.hpp"

#include <cmath>

namespace glidar::testing {
namespace {

void check(const TimedPose& pose) {
  constexpr double kRounding = 1e-12;
  demand(pose.position_m.allFinite(), "positions are finite");
  demand(std::abs(pose.orientation.norm() - 1.0) < kRounding, "quaternions are normalised");
}

void check_tree(const std::vector<dds::FramedPose>& poses) {
  dds::TransformTree tree;
  for (const dds::FramedPose& pose : poses) tree.set(pose, false);
  const auto found = tree.find(poses.front().frames.parent, poses.back().frames.child);
  if (!found) return;
  demand(std::abs(found->orientation.norm() - 1.0) < 1e-9, "chained rotations are normalised");
}

const ros::MessageType& type_of(std::byte selection) {
  switch (std::to_integer<int>(selection) % 3) {
    case 0:
      return ros::message_type<ros::TFMessage>();
    case 1:
      return ros::message_type<ros::Odometry>();
    default:
      return ros::message_type<ros::PoseStamped>();
  }
}

}  // namespace

bool try_ros_poses_decoders(std::span<const std::byte> bytes) {
  if (bytes.empty()) return false;
  const std::span<const std::byte> message = bytes.subspan(1);
  try {
    if (bytes.front() == std::byte{3}) {
      dds::decode_clock(message);
      return true;
    }
    const std::vector<dds::FramedPose> poses = dds::decode_poses(type_of(bytes.front()), message);
    for (const dds::FramedPose& pose : poses) {
      check(pose.pose);
      demand(pose.frames.child.size() <= dds::kMaxFrameName_bytes, "names are short");
    }
    if (!poses.empty()) check_tree(poses);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace glidar::testing
