// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/pose_topic.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/excerpt.hpp>
#include <glidar/link/dds/topic_names.hpp>

namespace glidar::dds {
namespace {

[[noreturn]] void refuse_topic(const std::string& text) {
  throw Error({"ROS topic of poses", "'" + excerpt(text) + "'",
               "/odom, /pose, /clock or /tf:PARENT:CHILD with two frames",
               "for example /tf:map:base_link"});
}

}  // namespace

PoseTopic parse_pose_topic(const std::string& text, const std::string& ros_namespace) {
  const std::size_t first = text.find(':');
  PoseTopic topic{.name = full_topic_name(text.substr(0, first), ros_namespace)};
  if (first == std::string::npos) return topic;
  const std::size_t second = text.find(':', first + 1);
  if (second == std::string::npos) refuse_topic(text);
  topic.parent_frame = text.substr(first + 1, second - first - 1);
  topic.child_frame = text.substr(second + 1);
  const bool is_valid = !topic.parent_frame.empty() && !topic.child_frame.empty() &&
                        topic.child_frame.find(':') == std::string::npos &&
                        topic.parent_frame != topic.child_frame;
  if (!is_valid) refuse_topic(text);
  return topic;
}

}  // namespace glidar::dds
