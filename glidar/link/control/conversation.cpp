// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/conversation.hpp>

#include <arpa/inet.h>
#include <netinet/in.h>

#include <array>

namespace glidar::control {

std::string canonical_ipv4(const std::string& text) {
  in_addr address{};
  std::array<char, INET_ADDRSTRLEN> made{};
  if (::inet_pton(AF_INET, text.c_str(), &address) != 1) return {};
  return ::inet_ntop(AF_INET, &address, made.data(), made.size());
}

std::array<std::byte, 4> ipv4_bytes(const std::string& text) {
  std::array<std::byte, 4> bytes{};
  ::inet_pton(AF_INET, text.c_str(), bytes.data());  // leaves it unchanged unless it succeeds
  return bytes;
}

std::string ipv4_text(std::span<const std::byte> bytes) {
  std::array<char, INET_ADDRSTRLEN> text{};
  return ::inet_ntop(AF_INET, bytes.first(4).data(), text.data(), text.size());
}

}  // namespace glidar::control
