// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/pose_decoder.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/excerpt.hpp>
#include <glidar/io/ros/codec.hpp>

#include <fmt/format.h>

#include <string_view>

namespace glidar::dds {
namespace {

void require_name(const std::string& name, std::string_view what) {
  const bool is_text = name.find('\0') == std::string::npos;
  if (!name.empty() && name.size() <= kMaxFrameName_bytes && is_text) return;
  throw Error({std::string(what), fmt::format("'{}', {} bytes", excerpt(name), name.size()),
               fmt::format("names of 1 to {} bytes without zero bytes", kMaxFrameName_bytes),
               "set it in the program that publishes the poses"});
}

void require_stamp(const ros::Time& stamp) {
  constexpr std::uint32_t kSecond_ns = 1'000'000'000;
  if (stamp.nanosec < kSecond_ns) return;
  throw Error({"stamp of a pose", fmt::format("nanosec {}", stamp.nanosec), "0 to 999999999", ""});
}

FramedPose checked_pose(const ros::Header& header, const FileText* child, const TimedPose& pose) {
  require_stamp(header.stamp);
  FramedPose framed{.frames = {ros::received_frame(header.frame_id), ""}, .pose = pose};
  require_name(framed.frames.parent, "frame_id of a pose");
  if (child != nullptr) {
    framed.frames.child = ros::received_frame(*child);
    require_name(framed.frames.child, "child_frame_id of a pose");
  }
  if (const auto error = find_error(nullptr, pose)) {
    throw Error({fmt::format("pose of {} in {}", excerpt(framed.frames.child),
                             excerpt(framed.frames.parent)),
                 error->found, error->allowed});
  }
  framed.pose.orientation.normalize();
  return framed;
}

std::vector<FramedPose> poses_of(const ros::TFMessage& message) {
  if (message.transforms.size() > kMaxTransforms) {
    throw Error({"message of transforms", fmt::format("{} transforms", message.transforms.size()),
                 fmt::format("up to {}", kMaxTransforms), ""});
  }
  std::vector<FramedPose> poses;
  for (const ros::TransformStamped& transform : message.transforms) {
    poses.push_back(
        checked_pose(transform.header, &transform.child_frame_id, ros::timed_pose(transform)));
  }
  return poses;
}

}  // namespace

std::vector<FramedPose> decode_poses(const ros::MessageType& type,
                                     std::span<const std::byte> message) {
  if (&type == &ros::message_type<ros::TFMessage>())
    return poses_of(ros::deserialize<ros::TFMessage>(message, ros::Wire::cdr));
  if (&type == &ros::message_type<ros::Odometry>()) {
    const auto odometry = ros::deserialize<ros::Odometry>(message, ros::Wire::cdr);
    return {checked_pose(odometry.header, &odometry.child_frame_id, ros::timed_pose(odometry))};
  }
  const auto pose = ros::deserialize<ros::PoseStamped>(message, ros::Wire::cdr);
  return {checked_pose(pose.header, nullptr, ros::timed_pose(pose))};
}

std::int64_t decode_clock(std::span<const std::byte> message) {
  const auto clock = ros::deserialize<ros::Clock>(message, ros::Wire::cdr);
  require_stamp(clock.clock);
  return ros::to_ns(clock.clock);
}

}  // namespace glidar::dds
