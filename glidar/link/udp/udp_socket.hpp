// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/unique_fd.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace glidar::link {

/// A UDP port of a host, which may be a broadcast or multicast address of IPv4.
struct UdpAddress {
  std::string host;              ///< as given
  std::uint32_t ip_address = 0;  ///< IPv4, in the order of the network
  std::uint16_t port = 0;
};

/// Throws Error when the host is not known.
UdpAddress resolve_udp_address(const std::string& host, std::uint16_t port);

/// Its IPv4 address as text: "127.0.0.1".
std::string ipv4_text(const UdpAddress& address);

/// Sends datagrams.
class UdpSocket {
 public:
  /// From any free port.
  UdpSocket();
  /// From this address. Throws Error when it is not one of this machine, or the port is in use.
  explicit UdpSocket(const UdpAddress& source);
  /// Throws Error when the system refuses.
  void send(std::span<const std::byte> payload, const UdpAddress& to) const;

 private:
  UniqueFd descriptor_;
};

}  // namespace glidar::link
