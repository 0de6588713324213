// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <stdexcept>

namespace glidar::testing {

/// RAII: a domain of DDS that no other test of this machine uses, here or in dds_support.py: a
/// socket at a port that belongs to the domain reserves it.
class FreeDomain {
 public:
  FreeDomain() {
    constexpr std::uint32_t kFirst = 1;
    constexpr std::uint32_t kLast = 99;  // above, its ports would be ephemeral ones
    for (id_ = kFirst; id_ <= kLast; ++id_) {
      if (reserve()) return;
    }
    throw std::runtime_error("all domains of DDS are in use");
  }
  ~FreeDomain() { close(socket_); }
  FreeDomain(const FreeDomain&) = delete;
  FreeDomain& operator=(const FreeDomain&) = delete;

  [[nodiscard]] std::uint32_t id() const { return id_; }

 private:
  bool reserve() {
    constexpr std::uint32_t kFirstPort = 19'000;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(kFirstPort + id_));
    socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
      return true;
    close(socket_);
    return false;
  }

  std::uint32_t id_ = 0;
  int socket_ = -1;
};

}  // namespace glidar::testing
