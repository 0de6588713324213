// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/unique_fd.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace glidar::link {

/// Sends datagrams to one host, which may be a broadcast or multicast address of IPv4.
class UdpSocket {
 public:
  /// Throws Error when the host is not known.
  explicit UdpSocket(const std::string& host);
  /// Throws Error when the system refuses.
  void send(std::span<const std::byte> payload, std::uint16_t port) const;

 private:
  std::string host_;
  std::uint32_t address_ = 0;  ///< IPv4, in the order of the network
  UniqueFd descriptor_;
};

}  // namespace glidar::link
