// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/peer_wait.hpp>

#include <apps/glidar/run/stream_report.hpp>
#include <glidar/core/elapsed_time.hpp>

#include <chrono>
#include <cstdint>
#include <utility>

namespace glidar::app {
namespace {

/// How often the handshakes of peers are polled.
constexpr std::chrono::milliseconds kPeerPollInterval{20};

bool are_complete(const Peers& peers, std::uint64_t subscribers) {
  if (peers.publisher != nullptr) peers.publisher->serve();
  const bool has_simulator = peers.receiver == nullptr || peers.receiver->is_ready();
  return has_simulator && (peers.publisher == nullptr || peers.publisher->has(subscribers));
}

bool lacks_simulator(const Peers& peers, const StreamFlags& flags, double waited_s) {
  return peers.receiver != nullptr && !peers.receiver->is_ready() && flags.pose_timeout_s &&
         waited_s > *flags.pose_timeout_s;
}

/// Prints the number of subscribers when it changes.
void show_subscribers(const Peers& peers, std::uint64_t expected, std::uint64_t& shown,
                      Console& console) {
  const std::uint64_t ready = peers.publisher != nullptr ? peers.publisher->ready() : 0;
  if (expected == 0 || std::exchange(shown, ready) == ready) return;
  console.info(ready_text(ready, expected));
}

}  // namespace

PeerWaitResult wait_for_peers(const Peers& peers, const StreamFlags& flags, const StopRequest& stop,
                              Console& console) {
  const auto begin = std::chrono::steady_clock::now();
  bool is_announced = false;
  std::uint64_t shown = 0;
  while (!are_complete(peers, flags.subscribers)) {
    if (stop.is_requested()) return PeerWaitResult::stopped;
    if (lacks_simulator(peers, flags, seconds_since(begin))) return PeerWaitResult::timed_out;
    if (!std::exchange(is_announced, true)) console.info(waiting_text(flags));
    show_subscribers(peers, flags.subscribers, shown, console);
    link::wait_for({peers.publisher != nullptr ? &peers.publisher->handshake_socket() : nullptr,
                    peers.receiver != nullptr ? &peers.receiver->handshake_socket() : nullptr},
                   stop.descriptor(), kPeerPollInterval);
  }
  return stop.is_requested() ? PeerWaitResult::stopped : PeerWaitResult::complete;
}

}  // namespace glidar::app
