// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace glidar::woods2016 {

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

}  // namespace glidar::woods2016
