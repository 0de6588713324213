// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/local_sockets.hpp>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <linux/filter.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
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

std::vector<LocalAddress> local_addresses() {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> list(first, freeifaddrs);
  std::vector<LocalAddress> addresses;
  for (const ifaddrs* entry = first; entry != nullptr; entry = entry->ifa_next) {
    const bool is_ipv4 = entry->ifa_addr != nullptr && entry->ifa_addr->sa_family == AF_INET;
    if (!is_ipv4 || (entry->ifa_flags & IFF_UP) == 0) continue;
    sockaddr_in address{};
    std::memcpy(&address, entry->ifa_addr, sizeof address);
    addresses.push_back({.interface_name = entry->ifa_name,
                         .address = ntohl(address.sin_addr.s_addr),
                         .is_loopback = (entry->ifa_flags & IFF_LOOPBACK) != 0,
                         .has_multicast = (entry->ifa_flags & IFF_MULTICAST) != 0});
  }
  return addresses;
}

/// The system itself drops packets from the network with an address of this machine as their
/// source.
bool accept_only(const std::vector<LocalAddress>& addresses, std::uint32_t domain) {
  // Classic BPF, linux/filter.h: load the source address of the IPv4 header; compare; accept.
  constexpr std::uint32_t kSource = static_cast<std::uint32_t>(SKF_NET_OFF) + 12;
  constexpr std::uint32_t kWhole = 0xFFFFFFFF;
  std::vector<sock_filter> program = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kSource)};
  for (const LocalAddress& address : addresses) {
    program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, address.address, 0, 1));
    program.push_back(BPF_STMT(BPF_RET | BPF_K, kWhole));
  }
  program.push_back(BPF_STMT(BPF_ALU | BPF_AND | BPF_K, 0xFF000000));
  program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, 0x7F000000, 0, 1));
  program.push_back(BPF_STMT(BPF_RET | BPF_K, kWhole));
  program.push_back(BPF_STMT(BPF_RET | BPF_K, 0));
  const sock_fprog filter{.len = static_cast<unsigned short>(program.size()),
                          .filter = program.data()};
  return std::ranges::all_of(domain_sockets(domain), [&](int descriptor) {
    return setsockopt(descriptor, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) == 0;
  });
}

}  // namespace glidar::dds
