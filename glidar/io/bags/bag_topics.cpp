// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/bag_topics.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace glidar::bags {
namespace {

std::string type_names(std::span<const ros::MessageType* const> types) {
  std::vector<std::string_view> names;
  for (const ros::MessageType* type : types) names.push_back(type->ros1_name);
  return fmt::format("a topic of {}", fmt::join(names, ", "));
}

}  // namespace

const ros::MessageType* type_of(const StoredTopic& topic) {
  return topic.is_ros ? ros::find_message_type(topic.type.bytes()) : nullptr;
}

std::size_t find_topic(const BagReader& bag, const std::string& name,
                       std::span<const ros::MessageType* const> types,
                       const std::filesystem::path& path) {
  const std::span<const StoredTopic> topics = bag.topics();
  std::vector<std::string> fitting;
  for (const ros::MessageType* type : types) {
    for (std::size_t i = 0; i < topics.size(); ++i) {
      if (type_of(topics[i]) != type) continue;
      if (name.empty() || topics[i].name == name) return i;
      fitting.push_back(topics[i].name.shown(60));
    }
  }
  const std::string found =
      name.empty() ? "no topic that fits" : fmt::format("no topic '{}' that fits", excerpt(name));
  const std::string near = closest_match(name, fitting);
  if (fitting.empty()) throw Error({path.string(), found, type_names(types)});
  constexpr std::size_t kMaxListed = 20;
  fitting.resize(std::min(fitting.size(), kMaxListed));
  throw Error({path.string(), found,
               fmt::format("{}: {}", type_names(types), fmt::join(fitting, " ")),
               near.empty() ? "" : fmt::format("did you mean '{}'?", near)});
}

}  // namespace glidar::bags
