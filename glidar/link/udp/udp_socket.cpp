// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/udp/udp_socket.hpp>

#include <glidar/core/error.hpp>

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

namespace glidar::link {
namespace {

[[noreturn]] void fail_to(const std::string& doing, const std::string& to, int error) {
  throw Error({.where = "UDP to " + to,
               .found = "cannot " + doing + ": " + std::strerror(error),
               .remedy = "give an IPv4 address or a host's name, such as 127.0.0.1"});
}

std::uint32_t find_address(const std::string& host) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(host.c_str(), nullptr, &wanted, &found) != 0 || found == nullptr) {
    fail_to("find the address", host, EINVAL);
  }
  sockaddr_in address{};
  std::memcpy(&address, found->ai_addr, sizeof address);
  ::freeaddrinfo(found);
  return address.sin_addr.s_addr;
}

}  // namespace

UdpSocket::UdpSocket(const std::string& host)
    : host_(host),
      address_(find_address(host)),
      descriptor_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  const int on = 1;
  if (descriptor_.get() < 0 ||
      ::setsockopt(descriptor_.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on) != 0) {
    fail_to("open a socket", host, errno);
  }
}

void UdpSocket::send(std::span<const std::byte> payload, std::uint16_t port) const {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = address_;
  const auto* address = reinterpret_cast<const sockaddr*>(&to);
  while (::sendto(descriptor_.get(), payload.data(), payload.size(), 0, address, sizeof to) < 0) {
    if (errno != EINTR) fail_to("send", host_ + ":" + std::to_string(port), errno);
  }
}

}  // namespace glidar::link
