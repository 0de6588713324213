// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/pose_decoder.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/ros/codec.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace glidar::dds {

bool TransformTree::set(const FramedPose& pose, bool is_static) {
  const std::string& child = pose.frames.child;
  if (child == pose.frames.parent) return false;
  if (edges_.size() >= kMaxFrames && !edges_.contains(child)) return false;
  Edge edge{.parent = pose.frames.parent, .parent_from_child = Pose::Identity(), .t_ns = {}};
  edge.parent_from_child.linear() = pose.pose.orientation.toRotationMatrix();
  edge.parent_from_child.translation() = pose.pose.position_m;
  if (!is_static) edge.t_ns = pose.pose.t_ns;
  edges_.insert_or_assign(child, std::move(edge));
  return true;
}

std::vector<TransformTree::Step> TransformTree::way_to_root(const std::string& first) const {
  constexpr std::size_t kMaxDepth = 1000;  // published transforms may form a loop
  std::vector<Step> steps = {{.frame = first, .newest_ns = {}}};
  for (auto edge = edges_.find(first); edge != edges_.end() && steps.size() < kMaxDepth;
       edge = edges_.find(steps.back().frame)) {
    const auto& [parent, parent_from_child, t_ns] = edge->second;
    const Step& last = steps.back();
    steps.push_back({.frame = parent,
                     .frame_from_first = parent_from_child * last.frame_from_first,
                     .newest_ns = std::max(last.newest_ns, t_ns)});
  }
  return steps;
}

std::optional<TimedPose> TransformTree::find(const std::string& parent,
                                             const std::string& child) const {
  const std::vector<Step> from_child = way_to_root(child);
  const std::vector<Step> from_parent = way_to_root(parent);
  for (const Step& up : from_child) {
    const auto common = std::ranges::find(from_parent, up.frame, &Step::frame);
    if (common == from_parent.end()) continue;
    const Pose parent_from_child = common->frame_from_first.inverse() * up.frame_from_first;
    return TimedPose{.t_ns = std::max(up.newest_ns, common->newest_ns).value_or(0),
                     .position_m = parent_from_child.translation(),
                     .orientation = Eigen::Quaterniond(parent_from_child.linear()).normalized()};
  }
  return std::nullopt;
}

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
    return poses_of(ros::deserialize<ros::TFMessage>(message));
  if (&type == &ros::message_type<ros::Odometry>()) {
    const auto odometry = ros::deserialize<ros::Odometry>(message);
    return {checked_pose(odometry.header, &odometry.child_frame_id, ros::timed_pose(odometry))};
  }
  const auto pose = ros::deserialize<ros::PoseStamped>(message);
  return {checked_pose(pose.header, nullptr, ros::timed_pose(pose))};
}

std::int64_t decode_clock(std::span<const std::byte> message) {
  const auto clock = ros::deserialize<ros::Clock>(message);
  require_stamp(clock.clock);
  return ros::to_ns(clock.clock);
}

}  // namespace glidar::dds
