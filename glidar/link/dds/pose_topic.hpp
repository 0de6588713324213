// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace glidar::dds {

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
