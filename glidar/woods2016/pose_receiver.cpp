// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/woods2016/pose_receiver.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace glidar::legacy {
namespace {

/// Poses are small; beyond, a peer is cut off. What is below is read and refused by its size.
constexpr std::int64_t kMaxMessageBytes = std::int64_t{16} << 20;

link::SocketOptions pose_socket_options(const PoseReceiverOptions& options) {
  return {.kind = link::SocketKind::subscribe,
          .receive_queue = std::max(options.queue, 1),
          .keeps_newest = options.queue == 0,
          .largest_message_bytes = kMaxMessageBytes,
          .is_watched = true};
}

link::Endpoint next_port(link::Endpoint endpoint) {
  ++endpoint.port;
  return endpoint;
}

/// How long a simulator whose handshakes' port is open may take to open its poses' port. Then the
/// handshake is requested without it.
constexpr std::chrono::seconds kPosesDelay{5};

/// Before a simulator that was cut off is connected to again.
constexpr std::chrono::seconds kReconnectDelay{1};

/// So that a flood of messages that are no poses does not keep the caller from anything else.
constexpr int kMaxMessagesAtOnce = 256;

constexpr link::SocketOptions kHandshakeSocket = {.kind = link::SocketKind::request,
                                                  .is_watched = true};

}  // namespace

PoseReceiver::PoseReceiver(link::Context& context, const PoseReceiverOptions& options,
                           link::FaultLog& faults)
    : context_(context),
      options_(options),
      faults_(faults),
      poses_(context, pose_socket_options(options)),
      handshake_(context, kHandshakeSocket) {
  open_poses();
  open_handshake();
}

bool PoseReceiver::is_ready() {
  if (awaits_reply_ && handshake_.receive()) {  // also of one that has sent all and gone since
    awaits_reply_ = false;
    is_ready_ = true;
  }
  notice_simulator();
  ask_when_connected();
  return is_ready_;
}

std::optional<Placement> PoseReceiver::receive() {
  notice_simulator();
  ask_when_connected();
  for (int i = 0; i < kMaxMessagesAtOnce && !is_over_; ++i) {
    const std::optional<link::Message> message = poses_.receive();
    if (!message) {
      tell_of_loss();
      connect_anew_if_cut_off();
      return std::nullopt;
    }
    ++counts_.received;
    if (std::optional<Placement> placement = read(*message)) return placement;
  }
  return std::nullopt;
}

std::optional<Placement> PoseReceiver::read(const link::Message& message) {
  if (!message.is_whole()) {
    refuse("it is one of several parts; a pose is a single one");
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
  faults_.tell("pose refused", why);
}

/// A simulator may start its clock anew, so that an earlier time is a fault but no reason to stop.
bool PoseReceiver::is_new(std::uint64_t timestamp) {
  const std::optional<std::uint64_t> before = std::exchange(last_timestamp_, timestamp);
  if (before == timestamp) {
    ++counts_.repeated;
    return false;
  }
  if (before && timestamp < *before) {
    ++counts_.backwards;
    faults_.tell("time went back", "from timestamp " + std::to_string(*before) + " to " +
                                       std::to_string(timestamp) +
                                       "; the cloud is made as for any other");
  }
  return true;
}

void PoseReceiver::open_poses() {
  poses_.subscribe(std::string_view(&kPlacementTopic, 1));
  poses_.connect(options_.endpoint);
}

/// Once all that it sent is read: one that said that it ends is not lost.
void PoseReceiver::tell_of_loss() {
  if (!std::exchange(is_loss_news_, false)) return;
  faults_.tell("simulator lost",
               "its connection ended, or it sent more than 16 MiB at once; waiting for it");
}

/// ZeroMQ finds a peer again that went away, but not one that it cut off.
void PoseReceiver::connect_anew_if_cut_off() {
  if (!lost_ || std::chrono::steady_clock::now() - *lost_ < kReconnectDelay) return;
  lost_.reset();
  poses_ = link::Socket(context_, pose_socket_options(options_));
  open_poses();
}

void PoseReceiver::open_handshake() {
  handshake_ = link::Socket(context_, kHandshakeSocket);
  handshake_.connect(next_port(options_.endpoint));
  reachable_.reset();
  has_asked_ = awaits_reply_ = false;
}

/// A simulator may send as soon as it has answered, so the subscription has to be there before the
/// question. It is written once the poses' connection stands; the handshake's is made anew after
/// that, and the simulator, which has one thread for both, reads it some round trips later. One
/// that waits for the handshake before it opens the poses' port is asked a little later all the
/// same.
void PoseReceiver::ask_when_connected() {
  if (has_asked_) return;
  const bool is_late = reachable_ && std::chrono::steady_clock::now() - *reachable_ >= kPosesDelay;
  if (!is_connected_ && !is_late) return;
  if (is_connected_) open_handshake();
  has_asked_ = true;
  awaits_reply_ = handshake_.send({});
}

/// One that comes back waits for a handshake as it did at first.
void PoseReceiver::notice_simulator() {
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
    is_loss_news_ = true;
    is_connected_ = false;
    open_handshake();
    lost_ = std::chrono::steady_clock::now();
  }
}

}  // namespace glidar::legacy
