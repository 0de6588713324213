// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/error.hpp>
#include <glidar/link/socket.hpp>

#include "support/waiting.hpp"

#include <cstdint>
#include <fstream>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace glidar::testing {

/// Makes an object that listens at a free port of this machine and at the next one.
template <class Make>
auto at_free_port(const Make& make) {
  std::random_device chance;
  for (int attempt = 0;; ++attempt) {
    constexpr unsigned kLowest = 20000;  // below the ephemeral ports
    constexpr unsigned kCount = 6000;
    constexpr int kMax = 100;
    const auto port = static_cast<std::uint16_t>(kLowest + 2 * (chance() % kCount));
    try {
      return make(link::Endpoint{"127.0.0.1", port});
    } catch (const Error&) {
      if (attempt == kMax) throw;
    }
  }
}

/// Whether an end of a TCP connection at this port of this machine is open, from the table of
/// proc(5): local address, remote address, state in hexadecimal, of which 06 (TIME_WAIT) and
/// 0A (LISTEN) are none.
inline bool has_connections(std::uint16_t port) {
  std::ifstream table("/proc/net/tcp");
  std::string line;
  std::getline(table, line);  // the header
  while (std::getline(table, line)) {
    std::istringstream words(line);
    std::string number;
    std::string local;
    std::string remote;
    std::string state;
    words >> number >> local >> remote >> state;
    const auto is_at = [port](const std::string& address) {
      constexpr int kHexadecimal = 16;
      return std::stoi(address.substr(address.find(':') + 1), nullptr, kHexadecimal) == port;
    };
    if ((is_at(local) || is_at(remote)) && state != "06" && state != "0A") return true;
  }
  return false;
}

/// The next message; empty when none comes.
inline std::vector<std::byte> received(link::Socket& socket) {
  std::optional<link::Message> message;
  if (!soon([&] { return (message = socket.receive()).has_value(); })) return {};
  return {message->bytes().begin(), message->bytes().end()};
}

}  // namespace glidar::testing
