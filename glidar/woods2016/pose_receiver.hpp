// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/fault_log.hpp>
#include <glidar/link/socket.hpp>
#include <glidar/woods2016/message_codec.hpp>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace glidar::legacy {

struct PoseReceiverOptions {
  link::Endpoint endpoint;  ///< of the poses; the handshake is at the next port
  int queue = 0;            ///< poses that wait, the oldest first; 0: the newest only
};

/// Takes poses from a simulator, by the protocol of 2015. A simulator that ends and comes back is
/// found again. Used by one thread at a time.
class PoseReceiver {
 public:
  /// Connects to both ports, now or once somebody listens there. The context and the log must
  /// outlive it.
  PoseReceiver(link::Context& context, const PoseReceiverOptions& options, link::FaultLog& faults);

  /// Whether the simulator has answered the handshake, for which it is asked once the subscription
  /// is there, so that no pose is missed; again when it went away before. To be called time and
  /// again.
  bool is_ready();
  /// The next pose; nothing: there is none now. Messages that are no poses are told to the log and
  /// passed over.
  std::optional<Placement> receive();
  /// True once the simulator said that it ends.
  [[nodiscard]] bool is_over() const { return is_over_; }

  [[nodiscard]] const link::Socket& pose_socket() const { return poses_; }
  [[nodiscard]] const link::Socket& handshake_socket() const { return handshake_; }

  struct Counts {
    std::uint64_t received = 0;   ///< messages
    std::uint64_t refused = 0;    ///< of these, that were no poses
    std::uint64_t repeated = 0;   ///< of the timestamp before, and therefore passed over
    std::uint64_t backwards = 0;  ///< of an earlier time than the one before
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  std::optional<Placement> read(const link::Message& message);
  void refuse(const std::string& why);
  [[nodiscard]] bool is_new(std::uint64_t timestamp);
  void open_poses();
  void open_handshake();
  void tell_of_loss();
  void connect_anew_if_cut_off();
  void ask_when_connected();
  void notice_simulator();

  link::Context& context_;
  PoseReceiverOptions options_;
  link::FaultLog& faults_;
  link::Socket poses_;
  link::Socket handshake_;
  std::optional<std::chrono::steady_clock::time_point> reachable_;  ///< its handshakes' port, since
  std::optional<std::chrono::steady_clock::time_point> lost_;       ///< since; empty: connected
  bool is_loss_news_ = false;                                       ///< not told yet
  bool is_connected_ = false;                                       ///< to its poses' port
  bool has_asked_ = false;
  bool awaits_reply_ = false;
  bool is_ready_ = false;
  bool is_over_ = false;
  std::optional<std::uint64_t> last_timestamp_;
  Counts counts_;
};

}  // namespace glidar::legacy
