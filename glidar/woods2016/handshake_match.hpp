// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace glidar::legacy {

/// Which handshakes have no subscription yet. A peer's handshake and its subscription come over
/// different connections, in any order, and do not say that they belong together: each handshake is
/// matched with one subscriber, the first that is not matched yet. Exact when all subscribers shake
/// hands; a subscriber that does not may be taken for that of a later handshake.
class HandshakeMatch {
 public:
  void add_handshake();
  /// The number of connections that are subscribed now.
  void set_subscribers(std::uint64_t count);
  /// Stops waiting for the subscriptions that are missing. Those that come later belong to these
  /// handshakes.
  void give_up();

  /// Handshakes whose subscription is missing.
  [[nodiscard]] std::uint64_t pending() const { return pending_; }
  /// Handshakes whose subscription came.
  [[nodiscard]] std::uint64_t matched() const { return matched_; }

 private:
  std::uint64_t pending_ = 0;
  std::uint64_t matched_ = 0;
  std::uint64_t subscribers_ = 0;
  std::uint64_t early_ = 0;   ///< subscribers without a handshake
  std::uint64_t absent_ = 0;  ///< handshakes whose subscriber left or was given up; it may come
};

}  // namespace glidar::legacy
