// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/woods2016/pose_receiver.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace glidar::woods2016 {
namespace {

/// Poses are small; a peer that sends more is cut off. Smaller messages are read and refused.
constexpr std::int64_t kMaxMessageBytes = std::int64_t{16} << 20;

link::SocketOptions pose_socket_options(const PoseReceiverOptions& options) {
  return {.kind = link::SocketKind::subscribe,
          .receive_queue = std::max(options.queue, 1),
          .keeps_newest = options.queue == 0,
          .max_message_bytes = kMaxMessageBytes,
          .reports_events = true};
}

link::Endpoint next_port(link::Endpoint endpoint) {
  ++endpoint.port;
  return endpoint;
}

/// Maximum delay between the opening of a simulator's handshake port and its pose port. After it,
/// the handshake is sent without a connection to the pose port.
constexpr std::chrono::seconds kPosesDelay{5};

/// Delay before reconnecting to a simulator that was cut off.
constexpr std::chrono::seconds kReconnectDelay{1};

/// So that a flood of invalid messages does not block the caller.
constexpr int kMaxMessagesAtOnce = 256;

constexpr link::SocketOptions kHandshakeSocket = {.kind = link::SocketKind::request,
                                                  .reports_events = true};

}  // namespace

PoseReceiver::PoseReceiver(link::Context& context, const PoseReceiverOptions& options,
                           link::ErrorLog& errors)
    : context_(context),
      options_(options),
      errors_(errors),
      poses_(context, pose_socket_options(options)),
      handshake_(context, kHandshakeSocket) {
  open_poses();
  open_handshake();
}

bool PoseReceiver::is_ready() {
  if (awaits_reply_ && handshake_.receive()) {
    awaits_reply_ = false;
    is_ready_ = true;
  }
  process_connection_events();
  send_handshake_when_connected();
  return is_ready_;
}

std::optional<Placement> PoseReceiver::receive() {
  process_connection_events();
  send_handshake_when_connected();
  for (int i = 0; i < kMaxMessagesAtOnce && !is_over_; ++i) {
    const std::optional<link::Message> message = poses_.receive();
    if (!message) {
      report_loss();
      reconnect_if_cut_off();
      return std::nullopt;
    }
    ++counts_.received;
    if (std::optional<Placement> placement = read(*message)) return placement;
  }
  return std::nullopt;
}

std::optional<Placement> PoseReceiver::read(const link::Message& message) {
  if (!message.is_whole()) {
    refuse("it has several parts; a pose has one");
    return std::nullopt;
  }
  if (is_shutdown(message.bytes())) {
    is_over_ = true;
    return std::nullopt;
  }
  try {
    Placement placement = decode_placement(message.bytes());
    if (is_new(placement.timestamp)) return placement;
  } catch (const Error& error) {
    refuse(error.what());
  }
  return std::nullopt;
}

void PoseReceiver::refuse(const std::string& why) {
  ++counts_.refused;
  errors_.report("pose refused", why);
}

/// A simulator may restart its clock, so a smaller timestamp is reported but accepted.
bool PoseReceiver::is_new(std::uint64_t timestamp) {
  const std::optional<std::uint64_t> before = std::exchange(last_timestamp_, timestamp);
  if (before == timestamp) {
    ++counts_.repeated;
    return false;
  }
  if (before && timestamp < *before) {
    ++counts_.backwards;
    errors_.report("timestamp decreased", "from timestamp " + std::to_string(*before) + " to " +
                                              std::to_string(timestamp) +
                                              "; the cloud is made as for any other");
  }
  return true;
}

void PoseReceiver::open_poses() {
  poses_.subscribe(std::string_view(&kPlacementTopic, 1));
  poses_.connect(options_.endpoint);
}

/// After all messages are read: a simulator that sent its end message is not lost.
void PoseReceiver::report_loss() {
  if (!std::exchange(loss_unreported_, false)) return;
  errors_.report("simulator lost",
                 "its connection ended, or it sent more than 16 MiB at once; waiting for it");
}

/// ZeroMQ reconnects to a peer that went away, but not to one that it cut off.
void PoseReceiver::reconnect_if_cut_off() {
  if (!lost_ || std::chrono::steady_clock::now() - *lost_ < kReconnectDelay) return;
  lost_.reset();
  poses_ = link::Socket(context_, pose_socket_options(options_));
  open_poses();
}

void PoseReceiver::open_handshake() {
  handshake_ = link::Socket(context_, kHandshakeSocket);
  handshake_.connect(next_port(options_.endpoint));
  reachable_.reset();
  handshake_sent_ = awaits_reply_ = false;
}

/// A simulator may send poses as soon as it has answered, so the subscription must arrive before
/// the handshake. The subscription is sent when the pose connection is established; then the
/// handshake connection is made again, and the simulator, which serves both in one thread, reads
/// the handshake some round trips later. A simulator that opens its pose port only after the
/// handshake gets the handshake after kPosesDelay.
void PoseReceiver::send_handshake_when_connected() {
  if (handshake_sent_) return;
  const bool is_late = reachable_ && std::chrono::steady_clock::now() - *reachable_ >= kPosesDelay;
  if (!is_connected_ && !is_late) return;
  if (is_connected_) open_handshake();
  handshake_sent_ = true;
  awaits_reply_ = handshake_.send({});
}

/// A simulator that restarts waits for a new handshake.
void PoseReceiver::process_connection_events() {
  for (const link::PeerEvent event : handshake_.events()) {
    if (event == link::PeerEvent::joined) reachable_ = std::chrono::steady_clock::now();
    if (event == link::PeerEvent::left) reachable_.reset();
    if (event == link::PeerEvent::left && !is_connected_) open_handshake();
  }
  for (const link::PeerEvent event : poses_.events()) {
    if (event == link::PeerEvent::joined) {
      is_connected_ = true;
      lost_.reset();
    }
    if (event != link::PeerEvent::left) continue;
    loss_unreported_ = true;
    is_connected_ = false;
    // It may have answered, sent all its poses and ended since the last call, and the reply is
    // lost.
    if (awaits_reply_ && link::wait_for({&poses_}, -1, {})) is_ready_ = true;
    open_handshake();
    lost_ = std::chrono::steady_clock::now();
  }
}

}  // namespace glidar::woods2016
