// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/udp/packet_sender.hpp>

#include <glidar/core/error.hpp>

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <utility>

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

namespace {

/// Two seconds of the fastest sensors.
constexpr std::size_t kMaxQueued = 20'000;

}  // namespace

PacketSender::PacketSender(const PacketRoute& route, double speed, ErrorLog& errors)
    : host_(resolve_udp_address(route.host, 0)), speed_(speed), errors_(errors) {
  for (const auto& [packet_port, port] : route.ports) {
    targets_[packet_port] = {host_.host, host_.ip_address, port};
  }
  for (const std::uint16_t port : route.source_ports) {
    source_sockets_.emplace(port, UdpSocket(resolve_udp_address(route.source, port)));
  }
  thread_ = std::thread([this] { run(); });
}

PacketSender::~PacketSender() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void PacketSender::send(std::vector<UdpPacket> packets, std::int64_t start_ns) {
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return queue_.size() < kMaxQueued; });
    const Clock::time_point now = Clock::now();
    if (!anchor_ || due_time(start_ns) < now) {  // the simulation is late: so is all that follows
      anchor_ = now;
      anchor_ns_ = start_ns;
    }
    for (UdpPacket& packet : packets) {
      queue_.push_back({due_time(packet.stamp_ns), std::move(packet)});
    }
  }
  changed_.notify_all();
}

PacketSender::Clock::time_point PacketSender::due_time(std::int64_t t_ns) const {
  if (speed_ <= 0.0) return *anchor_;
  const std::chrono::duration<double, std::nano> after(static_cast<double>(t_ns - anchor_ns_) /
                                                       speed_);
  return *anchor_ + std::chrono::duration_cast<Clock::duration>(after);
}

void PacketSender::redirect(std::uint16_t packet_port, const std::string& host,
                            std::uint16_t port) {
  UdpAddress target = resolve_udp_address(host, port);
  const std::lock_guard lock(mutex_);
  targets_[packet_port] = std::move(target);
}

UdpAddress PacketSender::target_of(std::uint16_t packet_port) const {
  const std::lock_guard lock(mutex_);
  const auto found = targets_.find(packet_port);
  if (found != targets_.end()) return found->second;
  return {host_.host, host_.ip_address, packet_port};
}

void PacketSender::finish(std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  last_due_ = Clock::now() + at_most;
  changed_.notify_all();
  changed_.wait(lock, [this] { return queue_.empty(); });
}

std::uint64_t PacketSender::sent() const {
  const std::lock_guard lock(mutex_);
  return sent_;
}

void PacketSender::run() {
  std::unique_lock lock(mutex_);
  while (!is_ending_) {
    if (queue_.empty()) {
      changed_.wait(lock);
      continue;
    }
    const Clock::time_point due = queue_.front().due;
    const Clock::time_point until = last_due_ ? std::min(due, *last_due_) : due;
    if (Clock::now() < until) {
      changed_.wait_until(lock, until);
      continue;
    }
    const UdpPacket packet = std::move(queue_.front().packet);
    lock.unlock();
    transmit(packet);
    lock.lock();
    queue_.pop_front();  // only now: finish() waits for the last packet
    changed_.notify_all();
  }
}

void PacketSender::transmit(const UdpPacket& packet) {
  try {
    const auto source = source_sockets_.find(packet.source_port);
    const UdpSocket& socket = source == source_sockets_.end() ? socket_ : source->second;
    socket.send(packet.payload, target_of(packet.port));
    const std::lock_guard lock(mutex_);
    ++sent_;
  } catch (const std::exception& error) {
    errors_.report("packets by UDP", error.what());
  }
}

}  // namespace glidar::link
