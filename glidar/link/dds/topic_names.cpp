// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/topic_names.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>

#include <algorithm>

namespace glidar::dds {
namespace {

/// rmw's RMW_TOPIC_MAX_NAME_LENGTH: DDS allows 256 bytes with the prefix.
constexpr std::size_t kMaxName_bytes = 247;

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Whether this is one name between two slashes.
bool is_token(std::string_view token) {
  return !token.empty() && is_letter(token.front()) &&
         std::ranges::all_of(token, [](char c) { return is_letter(c) || is_digit(c); });
}

bool is_full_name(std::string_view name) {
  if (!name.starts_with('/') || name.size() > kMaxName_bytes) return false;
  if (name.find("__") != std::string_view::npos) return false;
  for (std::size_t begin = 1;;) {
    const std::size_t slash = name.find('/', begin);
    if (!is_token(name.substr(begin, slash - begin))) return false;
    if (slash == std::string_view::npos) return true;
    begin = slash + 1;
  }
}

}  // namespace

std::string full_topic_name(std::string_view name, std::string_view ros_namespace) {
  std::string full;
  if (!name.starts_with('/')) {
    if (!ros_namespace.empty() && !ros_namespace.starts_with('/')) full = "/";
    full += ros_namespace;
    if (!full.ends_with('/')) full += '/';
  }
  full += name;
  if (is_full_name(full)) return full;
  throw Error({"ROS topic", "'" + excerpt(full) + "'",
               "letters, digits and single underscores, in parts between slashes that begin with "
               "no digit; up to 247 bytes",
               "for example /velodyne_points"});
}

std::string dds_topic_name(std::string_view full_name) {
  return "rt" + std::string(full_name);
}

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
