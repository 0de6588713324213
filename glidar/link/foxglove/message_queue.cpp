// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/message_queue.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

namespace glidar::foxglove {

std::size_t MessageQueue::push(ChannelMessage message, std::size_t depth) {
  const auto is_same = [channel = message.channel](const ChannelMessage& other) {
    return other.channel == channel;
  };
  const auto waiting =
      static_cast<std::size_t>(std::count_if(messages_.begin(), messages_.end(), is_same));
  if (waiting < depth) {
    messages_.push_back(std::move(message));
    return 0;
  }
  // each message of the channel takes the place of the one before it
  auto place = std::find_if(messages_.begin(), messages_.end(), is_same);
  for (auto next = place;
       (next = std::find_if(std::next(place), messages_.end(), is_same)) != messages_.end();
       place = next) {
    *place = std::move(*next);
  }
  *place = std::move(message);
  return 1;
}

std::optional<ChannelMessage> MessageQueue::pop() {
  if (messages_.empty()) return std::nullopt;
  ChannelMessage message = std::move(messages_.front());
  messages_.pop_front();
  return message;
}

void MessageQueue::remove(ChannelId channel) {
  std::erase_if(messages_, [&](const ChannelMessage& one) { return one.channel == channel; });
}

}  // namespace glidar::foxglove
