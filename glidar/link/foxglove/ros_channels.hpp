// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/codec.hpp>
#include <glidar/link/foxglove/server.hpp>
#include <glidar/link/payload.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar::foxglove {

/// Publishes ROS 2 messages to the clients of a server: a channel for each topic. Of clouds and
/// images a slow client receives the newest one; of transforms, odometry and IMU samples all of
/// about a second.
class RosChannels final : public ros::MessageSink {
 public:
  /// `keeps_newest`: messages are wanted also without subscribers, so that those that come later
  /// receive the newest one at once. The server must outlive it.
  RosChannels(FoxgloveServer& server, bool keeps_newest)
      : server_(server), keeps_newest_(keeps_newest) {}

  std::size_t add_topic(const ros::Topic& topic) override;
  [[nodiscard]] bool is_wanted(std::size_t topic) const override;
  /// A message of the type Clock also sets the time that clients show.
  void write(std::size_t topic, std::int64_t time_ns, std::span<const std::byte> message) override;
  void finish() override {}

 private:
  struct Entry {
    ChannelId channel = 0;
    bool is_clock = false;
    link::PayloadPool pool = {};  ///< of messages of similar size
  };
  FoxgloveServer& server_;
  bool keeps_newest_;
  std::vector<Entry> topics_;
};

}  // namespace glidar::foxglove
