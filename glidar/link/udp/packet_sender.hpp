// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/unique_fd.hpp>
#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/link/error_log.hpp>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

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

/// Where packets are sent.
struct PacketRoute {
  std::string host;                              ///< address or name of the receiver
  std::map<std::uint16_t, std::uint16_t> ports;  ///< by the packets' own port; others are kept
  std::string source = {};                       ///< address of the sensor; empty: any
  std::vector<std::uint16_t> source_ports = {};  ///< that packets are sent from; others: any port
};

/// Sends a sensor's packets by UDP in a thread of its own, each at its time, as the sensor does. A
/// receiver delays nothing; packets that it does not read are lost.
class PacketSender {
 public:
  using Clock = std::chrono::steady_clock;

  /// `speed`: how fast the packets' time passes; 0: packets are sent at once. Packets that cannot
  /// be sent are reported to the log, which must outlive it. Throws Error when the address is not
  /// valid.
  PacketSender(const PacketRoute& route, double speed, ErrorLog& errors);
  /// Sends no more packets.
  ~PacketSender();
  PacketSender(const PacketSender&) = delete;
  PacketSender& operator=(const PacketSender&) = delete;

  /// Queues packets in the order of their times, which pass from `start_ns` on, the start of their
  /// frame: now, or when the packets before were sent. Waits while too many are queued.
  void send(std::vector<UdpPacket> packets, std::int64_t start_ns);
  /// Sends the packets of a port, as the packets state it, to another host from now on. Throws
  /// Error when it is not known.
  void redirect(std::uint16_t packet_port, const std::string& host, std::uint16_t port);
  /// Waits until all packets are sent: those that are due later than `at_most` from now are sent
  /// then.
  void finish(std::chrono::milliseconds at_most);
  /// Packets that were sent.
  [[nodiscard]] std::uint64_t sent() const;

 private:
  struct Timed {
    Clock::time_point due;
    UdpPacket packet;
  };

  [[nodiscard]] Clock::time_point due_time(std::int64_t t_ns) const;
  [[nodiscard]] UdpAddress target_of(std::uint16_t packet_port) const;
  void run();
  void transmit(const UdpPacket& packet);

  UdpSocket socket_;
  std::map<std::uint16_t, UdpSocket> source_sockets_;  ///< by source port
  UdpAddress host_;
  double speed_;
  ErrorLog& errors_;

  mutable std::mutex mutex_;  ///< of what follows
  std::condition_variable changed_;
  std::map<std::uint16_t, UdpAddress> targets_;  ///< by the packets' own port
  std::deque<Timed> queue_;
  std::optional<Clock::time_point> anchor_;  ///< when the packets' time was anchor_ns_
  std::int64_t anchor_ns_ = 0;
  std::optional<Clock::time_point> last_due_;  ///< set by finish()
  std::uint64_t sent_ = 0;
  bool is_ending_ = false;
  std::thread thread_;
};

}  // namespace glidar::link
