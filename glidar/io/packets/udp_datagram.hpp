// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: UDP datagrams as a network carries them.

#include <glidar/io/packets/capture_reader.hpp>
#include <glidar/io/packets/packet_codec.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace glidar {

/// Sender and receiver of the datagrams in a capture file.
struct UdpRoute {
  std::array<std::uint8_t, 4> source = {192, 168, 1, 201};  ///< Velodyne's and Hesai's default
  std::array<std::uint8_t, 4> destination = {255, 255, 255, 255};
};

/// The largest payload of a datagram.
inline constexpr std::size_t kMaxUdpPayload = 65'507;

/// The Ethernet frames of a datagram, with checksums: several if it is larger than 1472 bytes
/// (RFC 791, RFC 768). `id` distinguishes the datagrams of a sender. Throws Error above
/// kMaxUdpPayload.
std::vector<std::vector<std::byte>> ethernet_frames(const UdpPacket& packet, const UdpRoute& route,
                                                    std::uint16_t id);

/// Extracts the UDP datagrams of captured IPv4 frames and joins fragments. Everything else is
/// ignored; memory is bounded.
class DatagramReader {
 public:
  /// The datagram that this record completes.
  std::optional<UdpPacket> add(const CaptureRecord& record);

 private:
  struct Partial {
    std::array<std::byte, 10> key{};  ///< source, destination and id
    std::size_t size = 0;             ///< 0: the last fragment is missing
    std::size_t received = 0;
    std::vector<bool> has_unit;  ///< units of 8 bytes
    std::vector<std::byte> bytes;
  };

  std::optional<UdpPacket> add_fragment(const Partial& found, std::size_t at, bool is_last,
                                        std::span<const std::byte> part, std::int64_t stamp_ns);

  std::deque<Partial> partials_;  ///< the oldest first
};

}  // namespace glidar
