// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/udp_datagram.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/packet_bytes.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace glidar {
namespace {

constexpr std::size_t kIpHead = 20;
constexpr std::size_t kUdpHead = 8;
constexpr std::size_t kMaxFragment = 1480;  // 1500 bytes of Ethernet, a multiple of 8
constexpr std::size_t kMaxPartials = 64;
constexpr std::size_t kMaxDatagram = 65'535;
constexpr std::uint8_t kUdp = 17;
constexpr std::uint16_t kIpv4 = 0x0800;

/// Sum of the ones' complement (RFC 1071).
std::uint32_t sum16(ByteView bytes, std::uint32_t sum = 0) {
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2)
    sum += static_cast<std::uint32_t>(get_big(bytes, i, 2));
  if (bytes.size() % 2 != 0) sum += std::to_integer<std::uint32_t>(bytes.back()) << 8U;
  while ((sum >> 16U) != 0) sum = (sum & 0xFFFFU) + (sum >> 16U);
  return sum;
}

std::uint16_t checksum(std::uint32_t sum) {
  return static_cast<std::uint16_t>(~sum & 0xFFFFU);
}

void put_address(Bytes& bytes, const std::array<std::uint8_t, 4>& address) {
  for (const std::uint8_t part : address) bytes.push_back(static_cast<std::byte>(part));
}

Bytes udp_datagram(const UdpPacket& packet, const UdpRoute& route) {
  const std::size_t size = kUdpHead + packet.payload.size();
  Bytes pseudo;
  put_address(pseudo, route.source);
  put_address(pseudo, route.destination);
  put_big(pseudo, kUdp, 2);
  put_big(pseudo, size, 2);
  Bytes bytes;
  bytes.reserve(size);
  put_big(bytes, packet.source_port, 2);
  put_big(bytes, packet.port, 2);
  put_big(bytes, size, 2);
  put_big(bytes, 0, 2);
  bytes.insert(bytes.end(), packet.payload.begin(), packet.payload.end());
  const std::uint16_t sum = checksum(sum16(bytes, sum16(pseudo)));
  const std::uint16_t sent = sum == 0 ? 0xFFFF : sum;  // 0 means none
  bytes[6] = static_cast<std::byte>(sent >> 8U);
  bytes[7] = static_cast<std::byte>(sent);
  return bytes;
}

/// The first 14 bytes of an Ethernet frame: a broadcast, or locally administered addresses.
void put_ethernet_head(Bytes& frame, const UdpRoute& route) {
  const bool is_broadcast = route.destination == std::array<std::uint8_t, 4>{255, 255, 255, 255};
  put_big(frame, is_broadcast ? 0xFFFFFFFFFFFFU : 0x020000000001U, 6);
  put_big(frame, 0x020000000002U, 6);
  put_big(frame, kIpv4, 2);
}

/// The IPv4 part of a record; empty if there is none.
ByteView ip_part(const CaptureRecord& record) {
  std::size_t at = 0;
  const ByteView bytes = record.bytes;
  switch (static_cast<LinkType>(record.link_type)) {
    case LinkType::null:
      at = 4;
      break;
    case LinkType::raw:
      break;
    case LinkType::linux_sll:
      at = 16;
      break;
    case LinkType::linux_sll2:
      at = 20;
      break;
    case LinkType::ethernet:
      at = 14;
      // VLAN tags (IEEE 802.1Q)
      while (at <= bytes.size() && at < 30 &&
             (get_big(bytes, at - 2, 2) == 0x8100 || get_big(bytes, at - 2, 2) == 0x88A8))
        at += 4;
      break;
    default:
      return {};
  }
  return at < bytes.size() ? bytes.subspan(at) : ByteView{};
}

std::optional<UdpPacket> udp_packet(ByteView datagram, std::int64_t stamp_ns) {
  if (datagram.size() < kUdpHead) return std::nullopt;
  const std::size_t size = get_big(datagram, 4, 2);
  if (size < kUdpHead || size > datagram.size()) return std::nullopt;
  const ByteView payload = datagram.subspan(kUdpHead, size - kUdpHead);
  return UdpPacket{stamp_ns, static_cast<std::uint16_t>(get_big(datagram, 0, 2)),
                   static_cast<std::uint16_t>(get_big(datagram, 2, 2)),
                   Bytes(payload.begin(), payload.end())};
}

}  // namespace

std::vector<std::vector<std::byte>> ethernet_frames(const UdpPacket& packet, const UdpRoute& route,
                                                    std::uint16_t id) {
  if (packet.payload.size() > kMaxUdpPayload) {
    throw Error(
        {"UDP packet", std::to_string(packet.payload.size()) + " bytes", "at most 65507 bytes"});
  }
  const Bytes datagram = udp_datagram(packet, route);
  std::vector<Bytes> frames;
  for (std::size_t at = 0; at < datagram.size(); at += kMaxFragment) {
    const std::size_t size = std::min(kMaxFragment, datagram.size() - at);
    const bool has_more = at + size < datagram.size();
    Bytes ip;
    put_big(ip, 0x4500, 2);
    put_big(ip, kIpHead + size, 2);
    put_big(ip, id, 2);
    put_big(ip, (has_more ? 0x2000U : 0U) | (at / 8), 2);
    put_big(ip, 64, 1);
    put_big(ip, kUdp, 1);
    put_big(ip, 0, 2);
    put_address(ip, route.source);
    put_address(ip, route.destination);
    const std::uint16_t sum = checksum(sum16(ip));
    ip[10] = static_cast<std::byte>(sum >> 8U);
    ip[11] = static_cast<std::byte>(sum);
    Bytes frame;
    frame.reserve(14 + kIpHead + size);
    put_ethernet_head(frame, route);
    frame.insert(frame.end(), ip.begin(), ip.end());
    const auto from = datagram.begin() + static_cast<std::ptrdiff_t>(at);
    frame.insert(frame.end(), from, from + static_cast<std::ptrdiff_t>(size));
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::optional<UdpPacket> DatagramReader::add(const CaptureRecord& record) {
  const ByteView ip = ip_part(record);
  if (ip.size() < kIpHead || (std::to_integer<unsigned>(ip[0]) >> 4U) != 4) return std::nullopt;
  const std::size_t head = 4 * (std::to_integer<std::size_t>(ip[0]) & 0xFU);
  const std::size_t size = get_big(ip, 2, 2);
  if (head < kIpHead || size < head || size > ip.size()) return std::nullopt;
  if (get_big(ip, 9, 1) != kUdp) return std::nullopt;
  const ByteView part = ip.subspan(head, size - head);
  const std::uint64_t place = get_big(ip, 6, 2);
  const bool has_more = (place & 0x2000U) != 0;
  const std::size_t at = 8 * (place & 0x1FFFU);
  if (!has_more && at == 0) return udp_packet(part, record.stamp_ns);
  Partial found;
  std::copy_n(ip.begin() + 12, 8, found.key.begin());
  std::copy_n(ip.begin() + 4, 2, found.key.begin() + 8);
  return add_fragment(found, at, !has_more, part, record.stamp_ns);
}

std::optional<UdpPacket> DatagramReader::add_fragment(const Partial& found, std::size_t at,
                                                      bool is_last, std::span<const std::byte> part,
                                                      std::int64_t stamp_ns) {
  if (part.empty() || at + part.size() > kMaxDatagram || (!is_last && part.size() % 8 != 0))
    return std::nullopt;
  auto place = std::find_if(partials_.begin(), partials_.end(),
                            [&](const Partial& one) { return one.key == found.key; });
  if (place == partials_.end()) {
    if (partials_.size() == kMaxPartials) partials_.pop_front();
    partials_.push_back(found);
    place = partials_.end() - 1;
  }
  Partial& partial = *place;
  const std::size_t end = at + part.size();
  partial.bytes.resize(std::max(partial.bytes.size(), end));
  partial.has_unit.resize((partial.bytes.size() + 7) / 8);
  std::copy(part.begin(), part.end(), partial.bytes.begin() + static_cast<std::ptrdiff_t>(at));
  for (std::size_t unit = at / 8; unit * 8 < end; ++unit) {
    if (!partial.has_unit[unit]) ++partial.received;
    partial.has_unit[unit] = true;
  }
  if (is_last) partial.size = end;
  const bool is_complete = partial.size > 0 && partial.received == (partial.size + 7) / 8;
  if (!is_complete) return std::nullopt;
  const Bytes whole(partial.bytes.begin(),
                    partial.bytes.begin() + static_cast<std::ptrdiff_t>(partial.size));
  partials_.erase(place);
  return udp_packet(whole, stamp_ns);
}

}  // namespace glidar
