// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/mcap_channels.hpp>

#include <fmt/format.h>

namespace glidar::bags {

McapRecord read_mcap_head(ByteReader& reader) {
  const auto op = static_cast<mcap::Op>(reader.number<std::uint8_t>());
  return {op, reader.number<std::uint64_t>()};
}

void McapChannels::add(mcap::Op op, ByteReader& content, InputBudget& budget) {
  if (op == mcap::Op::channel) return add_channel(content, budget);
  if (op != mcap::Op::schema) return;
  const auto number = content.number<std::uint16_t>();
  if (!schemas_.contains(number)) schemas_.emplace(number, content.name(budget));
}

void McapChannels::add_channel(ByteReader& content, InputBudget& budget) {
  const auto number = content.number<std::uint16_t>();
  const auto schema = content.number<std::uint16_t>();
  if (channels_.contains(number)) return;
  budget.take(Budget::topics, 1, content.place());
  StoredTopic topic;
  topic.name = content.name(budget);
  const std::string encoding = content.name(budget);
  const auto type = schemas_.find(schema);
  if (type != schemas_.end()) {
    budget.take_name(type->second.size(), content.place());
    topic.type = type->second;
  }
  topic.wire = encoding == "ros1" ? ros::Wire::ros1 : ros::Wire::cdr;
  topic.is_ros = encoding == "ros1" || encoding == "cdr";
  channels_.emplace(number, topics_.size());
  topics_.push_back(std::move(topic));
}

std::size_t McapChannels::topic_of(std::uint16_t channel, const ByteReader& reader) const {
  const auto known = channels_.find(channel);
  if (known == channels_.end())
    reader.reject(fmt::format("a message of channel {}, which is not described", channel));
  return known->second;
}

}  // namespace glidar::bags
