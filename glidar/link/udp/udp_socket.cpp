// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/udp/udp_socket.hpp>

#include <glidar/core/error.hpp>

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace glidar::link {
namespace {

[[noreturn]] void fail_to(const std::string& doing, const std::string& to, int error) {
  throw Error({.where = "UDP to " + to,
               .found = "cannot " + doing + ": " + std::strerror(error),
               .remedy = "give an IPv4 address or a host's name, such as 127.0.0.1"});
}

UniqueFd open_socket() {
  UniqueFd descriptor(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const int on = 1;
  if (descriptor.get() < 0 ||
      ::setsockopt(descriptor.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on) != 0) {
    throw Error(
        {.where = "UDP", .found = std::string("cannot open a socket: ") + std::strerror(errno)});
  }
  return descriptor;
}

sockaddr_in system_address(const UdpAddress& address) {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(address.port);
  at.sin_addr.s_addr = address.ip_address;
  return at;
}

}  // namespace

UdpAddress resolve_udp_address(const std::string& host, std::uint16_t port) {
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
  return {host, address.sin_addr.s_addr, port};
}

std::string ipv4_text(const UdpAddress& address) {
  std::array<char, INET_ADDRSTRLEN> text{};
  in_addr ip{};
  ip.s_addr = address.ip_address;
  return ::inet_ntop(AF_INET, &ip, text.data(), text.size());
}

UdpSocket::UdpSocket() : descriptor_(open_socket()) {}

UdpSocket::UdpSocket(const UdpAddress& source) : descriptor_(open_socket()) {
  const sockaddr_in at = system_address(source);
  if (::bind(descriptor_.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0) return;
  throw Error({.where = "UDP from " + source.host + ":" + std::to_string(source.port),
               .found = std::string("cannot use this address: ") + std::strerror(errno),
               .remedy = "give another address of this machine, such as 127.0.0.3"});
}

void UdpSocket::send(std::span<const std::byte> payload, const UdpAddress& to) const {
  const sockaddr_in at = system_address(to);
  const auto* address = reinterpret_cast<const sockaddr*>(&at);
  while (::sendto(descriptor_.get(), payload.data(), payload.size(), 0, address, sizeof at) < 0) {
    if (errno != EINTR) fail_to("send", to.host + ":" + std::to_string(to.port), errno);
  }
}

}  // namespace glidar::link
