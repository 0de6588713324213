// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/error.hpp>
#include <glidar/link/socket.hpp>

#include <chrono>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace glidar::testing {

/// Makes something that listens at a port of this machine and at the next one, both free.
template <class Make>
auto at_free_port(const Make& make) {
  std::random_device chance;
  for (int attempt = 0;; ++attempt) {
    constexpr unsigned kLowest = 20000;  // below those that systems give to clients
    constexpr unsigned kCount = 6000;
    constexpr int kMost = 100;
    const auto port = static_cast<std::uint16_t>(kLowest + 2 * (chance() % kCount));
    try {
      return make(link::Endpoint{"127.0.0.1", port});
    } catch (const Error&) {
      if (attempt == kMost) throw;
    }
  }
}

/// Repeats an action until it gives true; false when that takes longer than half a minute.
template <class Action>
bool soon(const Action& action) {
  const auto start = std::chrono::steady_clock::now();
  while (!action()) {
    if (std::chrono::steady_clock::now() - start > std::chrono::seconds(30)) return false;
    link::wait_for({}, -1, std::chrono::milliseconds(2));
  }
  return true;
}

/// The next message; empty when none comes.
inline std::vector<std::byte> received(link::Socket& socket) {
  std::optional<link::Message> message;
  if (!soon([&] { return (message = socket.receive()).has_value(); })) return {};
  return {message->bytes().begin(), message->bytes().end()};
}

}  // namespace glidar::testing
