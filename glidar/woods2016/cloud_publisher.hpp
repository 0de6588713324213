// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/cloud_sink.hpp>
#include <glidar/link/fault_log.hpp>
#include <glidar/link/router.hpp>
#include <glidar/woods2016/handshake_match.hpp>
#include <glidar/woods2016/message_codec.hpp>

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glidar::legacy {

/// What a cloud's timestamp is: that of the pose it was made for, which is the frame's stamp_ns
/// whatever its unit, or the number of the sensor's cloud, from 1, as where no simulator gives one.
enum class Timestamps : std::uint8_t { of_poses, counted };

struct CloudPublisherOptions {
  link::Endpoint endpoint = {};  ///< of the clouds; handshakes are at the next port
  bool keeps_newest = false;     ///< slow subscribers get the newest cloud only
  int queue = 32;                ///< clouds that wait for each subscriber; 0: any number
  std::uint32_t every = 1;       ///< publishes only every so many frames, from the first on
  link::Limits limits = {};
  Timestamps timestamps = Timestamps::counted;
  /// How long the first cloud waits for the subscription of a peer that has shaken hands.
  std::chrono::milliseconds subscription_timeout{10'000};
};

/// The topic of one of the sensors on a rig: "/NAME" and a zero byte.
std::string rig_topic(std::string_view name);

/// Publishes clouds to any number of subscribers, by the protocol of 2015. None of them can hold it
/// up: who is slow misses clouds, and those are counted. Used by one thread at a time.
class CloudPublisher final : public CloudSink {
 public:
  /// Listens at both ports. Throws Error when it cannot. The context and the log must outlive it.
  CloudPublisher(link::Context& context, const CloudPublisherOptions& options,
                 link::FaultLog& faults);

  /// What the clouds of each sensor begin with, by its Frame::sensor_id; those of others, and all
  /// until this is called, begin with 'c', since 2015's protocol knows one sensor.
  void set_topics(std::map<std::uint32_t, std::string> topics) { topics_ = std::move(topics); }

  /// Sends a cloud with the columns xyz (x left, y up, z forward) and intensity, once for each
  /// timestamp of a sensor.
  void write(const PointCloud& cloud, const Frame& frame) override;
  /// Whether the frame of this place in its sensor's sequence is to be published.
  [[nodiscard]] bool wants(std::uint64_t frame) const { return frame % options_.every == 0; }

  /// Answers who asks at the second port and notices who came and went.
  void serve();
  /// Whether at least so many peers have shaken hands, and the subscription of each peer that did
  /// has arrived, so that none of them misses the next cloud: a subscription comes over another
  /// connection than the handshake, often later. Once `subscription_timeout` has passed since the
  /// last handshake, a message is logged and the wait for missing subscriptions ends.
  /// Always true for 0.
  [[nodiscard]] bool has(std::uint64_t subscribers);
  /// Handshakes whose subscription has arrived.
  [[nodiscard]] std::uint64_t ready() const { return match_.matched(); }
  /// Tells subscribers that it is over; waits so long at most for subscriptions that are missing,
  /// again for full queues, and, when it is destroyed, again for what is on its way.
  void shut_down(std::chrono::milliseconds patience = std::chrono::seconds(1));

  [[nodiscard]] const link::Socket& handshake_socket() const { return handshakes_.socket(); }

  struct Counts {
    std::uint64_t handshakes = 0;
    std::uint64_t subscribers = 0;  ///< connections subscribed to a cloud's topic now
    std::uint64_t sent = 0;
    std::uint64_t missed = 0;    ///< of the sent ones, by one subscriber or more
    std::uint64_t repeated = 0;  ///< not sent: of the timestamp before
    std::uint64_t points = 0;
    std::uint64_t bytes = 0;
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  [[nodiscard]] std::vector<std::string> topics() const;
  [[nodiscard]] bool is_repeated(const Frame& frame, std::uint64_t timestamp);
  std::uint64_t timestamp_of(const Frame& frame);
  [[nodiscard]] bool is_settled() const;
  void give_up_subscriptions(std::chrono::milliseconds waited);
  void answer_handshakes();
  void notice_peers();
  void set_subscribers(std::uint64_t count);

  CloudPublisherOptions options_;
  link::FaultLog& faults_;
  link::Socket clouds_;
  link::Router handshakes_;
  std::shared_ptr<link::PayloadPool> pool_ = std::make_shared<link::PayloadPool>();
  std::map<std::uint32_t, std::uint64_t> counted_;          ///< clouds of each sensor
  std::map<std::uint32_t, std::string> topics_;             ///< by sensor
  std::map<std::uint32_t, std::uint64_t> last_timestamps_;  ///< likewise
  HandshakeMatch match_;
  std::chrono::steady_clock::time_point last_handshake_;
  std::chrono::steady_clock::time_point last_change_;  ///< handshake, or subscriber that came
  bool knows_subscribers_ = false;
  Counts counts_;
};

}  // namespace glidar::legacy
