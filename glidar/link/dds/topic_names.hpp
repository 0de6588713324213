// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace glidar::dds {

/// The full name of a ROS topic: names without a leading slash are in the namespace, which may be
/// empty, "robot" or "/fleet/robot". Throws Error unless it is a valid name of ROS 2:
/// design.ros2.org/articles/topic_and_service_names.html.
std::string full_topic_name(std::string_view name, std::string_view ros_namespace = {});

/// The name of a topic in DDS: rt/velodyne_points for /velodyne_points.
std::string dds_topic_name(std::string_view full_name);

/// The topic that poses come from.
struct PoseTopic {
  std::string name;               ///< full name
  std::string parent_frame = {};  ///< of transforms; empty: the topic has odometry or poses
  std::string child_frame = {};
};

/// Parses "/odom", "/pose" or "/tf:PARENT:CHILD". Throws Error.
PoseTopic parse_pose_topic(const std::string& text, const std::string& ros_namespace = {});

/// Whether the frames of transforms are named.
inline bool has_frames(const PoseTopic& topic) {
  return !topic.parent_frame.empty();
}

}  // namespace glidar::dds
