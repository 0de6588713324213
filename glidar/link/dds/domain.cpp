// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/domain.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <linux/filter.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

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

namespace {

constexpr std::uint32_t kMaxDomain = 232;
constexpr const char* kDomainVariable = "ROS_DOMAIN_ID";

[[noreturn]] void refuse_domain(const char* where, const std::string& found) {
  throw Error({where, "'" + excerpt(found) + "'", "a whole number from 0 to 232",
               "choose the domain of your ROS 2 nodes"});
}

/// The highest participant index whose ports exist: OMG DDSI-RTPS 2.5, 9.6.2.3, with the default
/// port base 7400, 250 ports per domain and 2 per participant.
std::uint32_t max_participant_index(std::uint32_t domain) {
  constexpr std::uint32_t kMaxPort = 65535;
  constexpr std::uint32_t kMaxIndex = 119;
  return std::min(kMaxIndex, (kMaxPort - 7411 - 250 * domain) / 2);
}

std::string interface_names() {
  const std::unique_ptr<struct if_nameindex, decltype(&if_freenameindex)> list(if_nameindex(),
                                                                               if_freenameindex);
  std::string names = kAnyInterface;
  for (const struct if_nameindex* entry = list.get(); entry != nullptr && entry->if_name != nullptr;
       ++entry) {
    names += fmt::format(", {}", entry->if_name);
  }
  return names;
}

/// Linux allows quotes and angle brackets in names, the configuration does not.
bool is_plain(const std::string& name) {
  return name.find_first_of("<>&\"' \t\n") == std::string::npos;
}

void require_interface(const std::string& name) {
  if (is_plain(name) && if_nametoindex(name.c_str()) != 0) return;
  throw Error({"network interface of ROS 2", "'" + excerpt(name) + "'",
               "one of this machine: " + interface_names(), ""});
}

/// Datagrams as large as IP allows: the loopback interface never divides them, so a cloud needs a
/// tenth of the packets.
constexpr std::string_view kLoopbackSizes =
    "<MaxMessageSize>65000 B</MaxMessageSize><MaxRexmitMessageSize>65000 B</MaxRexmitMessageSize>"
    "<FragmentSize>64000 B</FragmentSize>";

/// Nodes of ROS 2 use the interface to the network by default, also among themselves on a machine,
/// and Cyclone DDS ignores addresses of interfaces that it does not use. Multicast with a time to
/// live of 0 does not leave the machine.
std::string local_interfaces() {
  constexpr std::size_t kMax = 3;  // Cyclone DDS 0.10 has 4 in all
  std::string text = R"(<Interfaces><NetworkInterface name="lo" multicast="true"/>)";
  std::vector<std::string> names;
  for (const LocalAddress& local : local_addresses()) {
    const std::string& name = local.interface_name;
    const bool is_known = std::ranges::find(names, name) != names.end();
    if (local.is_loopback || !local.has_multicast || is_known || names.size() == kMax) continue;
    if (!is_plain(name)) continue;
    text += fmt::format(R"(<NetworkInterface name="{}"/>)", name);
    names.push_back(name);
  }
  return text + "</Interfaces><MulticastTimeToLive>0</MulticastTimeToLive>";
}

}  // namespace

std::uint32_t domain_id(const DomainOptions& options) {
  if (options.id) {
    if (*options.id > kMaxDomain) refuse_domain("ROS domain", std::to_string(*options.id));
    return *options.id;
  }
  const char* variable = std::getenv(kDomainVariable);
  if (variable == nullptr || *variable == '\0') return 0;
  const std::string_view text = variable;
  std::uint32_t id = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error != std::errc() || stop != text.data() + text.size() || id > kMaxDomain) {
    refuse_domain(kDomainVariable, std::string(text));
  }
  return id;
}

std::string domain_config(const DomainOptions& options) {
  const bool is_any = options.interface_name == kAnyInterface;
  const bool is_loopback = options.interface_name == kLoopbackInterface;
  std::string general;
  std::string discovery;
  if (!is_any) require_interface(options.interface_name);
  if (!is_any && !is_loopback) {
    general = fmt::format(R"(<Interfaces><NetworkInterface name="{}"/></Interfaces>)",
                          options.interface_name);
  }
  if (is_loopback) {
    general = local_interfaces();
    general += kLoopbackSizes;
    // Nodes that use the loopback interface without multicast look at the ports of the first
    // participants, and are found there.
    discovery = fmt::format(
        "<ParticipantIndex>auto</ParticipantIndex>"
        "<MaxAutoParticipantIndex>{}</MaxAutoParticipantIndex>"
        R"(<Peers><Peer address="127.0.0.1"/></Peers>)",
        max_participant_index(domain_id(options)));
  }
  std::string config = fmt::format(
      R"(<CycloneDDS><Domain Id="any"><General>{}</General><Discovery>{}</Discovery><Internal>)"
      R"(<SocketReceiveBufferSize max="{} B"/><SocketSendBufferSize max="{} B"/>)"
      "<MaxQueuedRexmitBytes>{} B</MaxQueuedRexmitBytes></Internal></Domain></CycloneDDS>",
      general, discovery, kSocketBuffer_bytes, kSocketBuffer_bytes, 8 * kSocketBuffer_bytes);
  const char* given = std::getenv("CYCLONEDDS_URI");
  if (is_any && given != nullptr && *given != '\0') config += fmt::format(",{}", given);
  return config;
}

std::string socket_buffer_advice(std::size_t limit_bytes) {
  if (limit_bytes >= kSocketBuffer_bytes) return "";
  return fmt::format(
      "the system limits socket buffers to {} bytes, so large clouds may arrive late; raise the "
      "limit with: sudo sysctl -w net.core.rmem_max={} net.core.wmem_max={}",
      limit_bytes, kSocketBuffer_bytes, kSocketBuffer_bytes);
}

std::optional<std::size_t> socket_buffer_limit() {
  std::ifstream file("/proc/sys/net/core/rmem_max");
  std::size_t bytes = 0;
  if (!(file >> bytes)) return std::nullopt;
  return bytes;
}

}  // namespace glidar::dds
