// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/foxglove/messages.hpp>
#include <glidar/link/payload.hpp>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace glidar::foxglove {

/// A message of a channel on its way to clients.
struct ChannelMessage {
  ChannelId channel = 0;
  std::uint64_t time_ns = 0;
  link::Payload payload = {};
};

/// Messages that wait: of each channel the newest ones, as many as its depth. Channels take turns:
/// a newer message takes the place in the queue of the one that is dropped.
class MessageQueue {
 public:
  /// `depth`, from 1, is the number of this channel's messages to keep. Returns the number of
  /// messages that were dropped.
  std::size_t push(ChannelMessage message, std::size_t depth);
  /// The message that has waited longest; empty if there is none.
  std::optional<ChannelMessage> pop();
  void remove(ChannelId channel);
  [[nodiscard]] std::size_t size() const { return messages_.size(); }

 private:
  std::deque<ChannelMessage> messages_;
};

}  // namespace glidar::foxglove
