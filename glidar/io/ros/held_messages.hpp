// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/ros.

#include <glidar/core/memory_pool.hpp>
#include <glidar/io/ros/codec.hpp>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace glidar::ros {

/// Serialized messages that wait for earlier ones, by time; those of one time stay in their order.
class HeldMessages {
 public:
  struct Held {
    std::int64_t time_ns = 0;
    std::optional<std::size_t> topic;  ///< empty: only a time
    std::vector<std::byte> bytes;
  };

  /// The memory of a message that was written, for later ones.
  void give_back(std::vector<std::byte> memory) { written_.give_back(std::move(memory)); }

  void hold(Held message);
  /// Serializes a message.
  template <class Message>
  void hold(std::size_t topic, std::int64_t time_ns, const Message& message) {
    std::size_t size = 0;
    if constexpr (requires { message.data.size(); }) size = message.data.size();
    std::vector<std::byte> bytes = written_.take(size);
    serialize_to(message, bytes);
    hold({.time_ns = time_ns, .topic = topic, .bytes = std::move(bytes)});
  }
  /// Removes the first message if its time is at most `until_ns`.
  std::optional<Held> release(std::int64_t until_ns);

 private:
  std::deque<Held> held_;
  MemoryPool written_;
};

}  // namespace glidar::ros
