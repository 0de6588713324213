// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/link/error_log.hpp>
#include <glidar/link/socket.hpp>

#include <Eigen/Geometry>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glidar::woods2016 {

/// Messages of the Woods 2016 protocol; docs/link/woods2016-protocol.md has the tables. All numbers
/// are little-endian, without padding; the first byte is both the type and the topic.

using Bytes = std::span<const std::byte>;

inline constexpr char kCloudTopic = 'c';
inline constexpr char kPlacementTopic = 'v';

/// Maximum deviation of a quaternion's length from 1: attitudes in single precision are valid, a
/// missing or misplaced component is not.
inline constexpr double kQuaternionTolerance = 1e-3;

/// 'v', from a simulator: the poses of object and sensor. The quaternions are attitudes, which
/// rotate inertial vectors into the body:
///   p_sensor = R(sensor) (R(object)^T p_object + translation)
/// in the frame x left, y up, z forward.
struct Placement {
  std::uint64_t timestamp = 0;  ///< of the simulator's clock, in any unit
  Eigen::Quaterniond object = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond sensor = Eigen::Quaterniond::Identity();
};

inline constexpr std::size_t kPlacementBytes = 1 + 8 + 11 * 8;

/// Quaternions are returned normalised. Throws Error unless size and topic are correct, every
/// number is finite, positions are within kMaxCoordinate_m and quaternions have length 1.
Placement decode_placement(Bytes message);

std::array<std::byte, kPlacementBytes> encode_placement(const Placement& placement);

/// 'c', to subscribers: x y z in metres (x left, y up, z forward) and intensity.
struct CloudPoint {
  float x_m = 0.0F;
  float y_m = 0.0F;
  float z_m = 0.0F;
  float intensity = 0.0F;
};

struct Cloud {
  std::uint64_t timestamp = 0;
  std::vector<CloudPoint> points;
};

/// Throws Error unless the topic is correct, the size is that of whole points, and every number is
/// finite.
Cloud decode_cloud(Bytes message);

/// Size in bytes of a cloud message with this number of points.
constexpr std::size_t cloud_bytes(std::size_t points) {
  return 1 + 8 + points * sizeof(CloudPoint);
}

/// Writes the points that are hits and returns the size of the message; `to` must have
/// cloud_bytes(cloud.size()) bytes. The cloud must have the protocol's axes. Throws Error if the
/// column xyz or intensity is missing, or if `to` is too small.
std::size_t encode_cloud(const PointCloud& cloud, std::uint64_t timestamp, std::span<std::byte> to);

/// The message that ends a topic: for example "cKTHXBAI".
std::vector<std::byte> encode_shutdown(std::string_view topic);

/// True for the end message of any topic.
bool is_shutdown(Bytes message);

/// Matches handshakes with subscriptions. The handshake and the subscription of a peer use
/// different connections, arrive in any order, and cannot be associated: each handshake is matched
/// with the first unmatched subscriber. This is exact if all subscribers shake hands; a subscriber
/// that does not may be matched with a later handshake.
class HandshakeMatch {
 public:
  void add_handshake();
  /// Sets the number of connections that are subscribed now.
  void set_subscribers(std::uint64_t count);
  /// Stops waiting for missing subscriptions. Later subscriptions are matched with these
  /// handshakes.
  void stop_waiting();

  /// Handshakes whose subscription is missing.
  [[nodiscard]] std::uint64_t pending() const { return pending_; }
  /// Handshakes whose subscription has arrived.
  [[nodiscard]] std::uint64_t matched() const { return matched_; }

 private:
  std::uint64_t pending_ = 0;
  std::uint64_t matched_ = 0;
  std::uint64_t subscribers_ = 0;
  std::uint64_t early_ = 0;   ///< subscribers without a handshake
  std::uint64_t absent_ = 0;  ///< handshakes whose subscriber left or timed out; it may still come
};

struct PoseReceiverOptions {
  link::Endpoint endpoint;  ///< of the poses; the handshake uses the next port
  int queue = 0;            ///< queued poses, oldest first; 0: the newest only
};

/// Receives poses from a simulator by the Woods 2016 protocol. It reconnects to a simulator that
/// restarts. Used by one thread at a time.
class PoseReceiver {
 public:
  /// Connects to both ports, now or when a simulator listens there. The context and the log must
  /// outlive it.
  PoseReceiver(link::Context& context, const PoseReceiverOptions& options, link::ErrorLog& errors);

  /// True if the simulator has answered the handshake, which is sent after the subscription, so
  /// that no pose is missed, and again after a reconnection; also if it has left and its poses
  /// wait. To be called repeatedly.
  bool is_ready();
  /// The next pose; empty if there is none now. Invalid messages are logged and skipped.
  std::optional<Placement> receive();
  /// True after the end message of the simulator.
  [[nodiscard]] bool is_over() const { return is_over_; }

  [[nodiscard]] const link::Socket& pose_socket() const { return poses_; }
  [[nodiscard]] const link::Socket& handshake_socket() const { return handshake_; }

  struct Counts {
    std::uint64_t received = 0;   ///< messages
    std::uint64_t refused = 0;    ///< invalid messages among these
    std::uint64_t repeated = 0;   ///< skipped: same timestamp as before
    std::uint64_t backwards = 0;  ///< timestamp smaller than before
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  std::optional<Placement> read(const link::Message& message);
  void refuse(const std::string& why);
  [[nodiscard]] bool is_new(std::uint64_t timestamp);
  void open_poses();
  void open_handshake();
  void report_loss();
  void reconnect_if_cut_off();
  void send_handshake_when_connected();
  void process_connection_events();

  link::Context& context_;
  PoseReceiverOptions options_;
  link::ErrorLog& errors_;
  link::Socket poses_;
  link::Socket handshake_;
  std::optional<std::chrono::steady_clock::time_point>
      reachable_;  ///< handshake port connected since
  std::optional<std::chrono::steady_clock::time_point>
      lost_;                      ///< poses disconnected since; empty: connected
  bool loss_unreported_ = false;  ///< the loss is not logged yet
  bool is_connected_ = false;     ///< to the port of the poses
  bool handshake_sent_ = false;
  bool awaits_reply_ = false;
  bool is_ready_ = false;
  bool is_over_ = false;
  std::optional<std::uint64_t> last_timestamp_;
  Counts counts_;
};

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
