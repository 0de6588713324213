// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/udp/packet_sender.hpp>

#include <algorithm>
#include <exception>
#include <utility>

namespace glidar::link {
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
