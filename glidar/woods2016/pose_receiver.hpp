// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/error_log.hpp>
#include <glidar/link/socket.hpp>
#include <glidar/woods2016/message_codec.hpp>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace glidar::woods2016 {

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

}  // namespace glidar::woods2016
