// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/loopback_sockets.hpp>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace glidar::dds {
namespace {

/// OMG DDSI-RTPS 2.5, 9.6.2.3: 250 ports per domain from 7400 on.
bool is_port_of(std::uint32_t port, std::uint32_t domain) {
  const std::uint32_t first = 7400 + 250 * domain;
  return port >= first && port < first + 250;
}

bool is_socket_of(int descriptor, std::uint32_t domain) {
  int kind = 0;
  socklen_t size = sizeof kind;
  if (getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &kind, &size) != 0 || kind != SOCK_DGRAM)
    return false;
  sockaddr_in address{};
  size = sizeof address;
  return getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
         address.sin_family == AF_INET && is_port_of(ntohs(address.sin_port), domain);
}

}  // namespace

std::vector<int> domain_sockets(std::uint32_t domain) {
  std::vector<int> sockets;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const std::string name = entry.path().filename().string();
    int descriptor = -1;
    std::from_chars(name.data(), name.data() + name.size(), descriptor);
    if (is_socket_of(descriptor, domain)) sockets.push_back(descriptor);
  }
  return sockets;
}

bool restrict_to_loopback(std::uint32_t domain) {
  constexpr std::string_view kLoopback = "lo";
  return std::ranges::all_of(domain_sockets(domain), [&](int descriptor) {
    return setsockopt(descriptor, SOL_SOCKET, SO_BINDTODEVICE, kLoopback.data(),
                      static_cast<socklen_t>(kLoopback.size())) == 0;
  });
}

}  // namespace glidar::dds
