// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/link/error_log.hpp>
#include <glidar/link/router.hpp>
#include <glidar/woods2016/handshake_match.hpp>
#include <glidar/woods2016/message_codec.hpp>

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glidar::woods2016 {

/// The timestamp of a cloud: that of its pose, which is the frame's stamp_ns in the simulator's
/// unit, or the number of the sensor's cloud, from 1, without a simulator.
enum class Timestamps : std::uint8_t { of_poses, counted };

struct CloudPublisherOptions {
  link::Endpoint endpoint = {};  ///< of the clouds; handshakes use the next port
  bool keeps_newest = false;     ///< slow subscribers get the newest cloud only
  int queue = 32;                ///< clouds queued for each subscriber; 0: unlimited
  std::uint32_t every = 1;       ///< publishes every n-th frame, starting with the first
  link::Limits limits = {};
  Timestamps timestamps = Timestamps::counted;
  /// Maximum time that the first cloud waits for the subscription of a peer that has shaken hands.
  std::chrono::milliseconds subscription_timeout{10'000};
};

/// The topic of a sensor on a rig: "/NAME" and a zero byte.
std::string rig_topic(std::string_view name);

/// Publishes clouds to any number of subscribers by the Woods 2016 protocol. Subscribers cannot
/// block it: slow subscribers miss clouds, which are counted. Used by one thread at a time.
class CloudPublisher {
 public:
  /// Listens at both ports. Throws Error if it cannot. The context and the log must outlive it.
  CloudPublisher(link::Context& context, const CloudPublisherOptions& options,
                 link::ErrorLog& errors);

  /// Sets the topic of each sensor's clouds, by Frame::sensor_id. Clouds of other sensors, and all
  /// clouds before this call, have the topic 'c', because the original protocol has one sensor.
  void set_topics(std::map<std::uint32_t, std::string> topics) { topics_ = std::move(topics); }

  /// Sends a cloud with the columns xyz (x left, y up, z forward, metres) and intensity, once per
  /// timestamp of a sensor.
  void write(const PointCloud& cloud, const Frame& frame);
  /// True if the frame with this number in its sensor's sequence is to be published.
  [[nodiscard]] bool wants(std::uint64_t frame) const { return frame % options_.every == 0; }

  /// Answers handshakes and processes connection events.
  void serve();
  /// True if at least this number of peers have shaken hands and the subscriptions of all of them
  /// have arrived, so that none misses the next cloud: a subscription uses another connection than
  /// the handshake and often arrives later. When `subscription_timeout` has passed since the last
  /// handshake, a message is logged and the wait for missing subscriptions ends.
  /// Always true for 0.
  [[nodiscard]] bool has(std::uint64_t subscribers);
  /// Handshakes whose subscription has arrived.
  [[nodiscard]] std::uint64_t ready() const { return match_.matched(); }
  /// Sends the end message to all subscribers. Waits up to `timeout` for missing subscriptions,
  /// again for full queues, and, in the destructor, again for unsent messages.
  void shut_down(std::chrono::milliseconds timeout = std::chrono::seconds(1));

  [[nodiscard]] const link::Socket& handshake_socket() const { return handshakes_.socket(); }

  struct Counts {
    std::uint64_t handshakes = 0;
    std::uint64_t subscribers = 0;  ///< connections that are subscribed to a cloud topic now
    std::uint64_t sent = 0;
    std::uint64_t missed = 0;    ///< sent clouds that at least one subscriber missed
    std::uint64_t repeated = 0;  ///< not sent: same timestamp as before
    std::uint64_t points = 0;
    std::uint64_t bytes = 0;
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  [[nodiscard]] std::vector<std::string> topics() const;
  [[nodiscard]] bool is_repeated(const Frame& frame, std::uint64_t timestamp);
  std::uint64_t timestamp_of(const Frame& frame);
  [[nodiscard]] bool all_subscribed() const;
  void stop_waiting_for_subscriptions(std::chrono::milliseconds waited);
  void answer_handshakes();
  void process_peer_events();
  void set_subscribers(std::uint64_t count);

  CloudPublisherOptions options_;
  link::ErrorLog& errors_;
  link::Socket clouds_;
  link::Router handshakes_;
  link::PayloadPool pool_;
  std::map<std::uint32_t, std::uint64_t> counted_;          ///< clouds of each sensor
  std::map<std::uint32_t, std::string> topics_;             ///< by sensor
  std::map<std::uint32_t, std::uint64_t> last_timestamps_;  ///< by sensor
  HandshakeMatch match_;
  std::chrono::steady_clock::time_point last_handshake_;
  std::chrono::steady_clock::time_point last_change_;  ///< handshake or new subscriber
  bool knows_subscribers_ = false;
  Counts counts_;
};

}  // namespace glidar::woods2016
