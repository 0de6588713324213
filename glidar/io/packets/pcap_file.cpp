// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/pcap_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/packet_bytes.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace glidar {
namespace {

const InputFileKind kCapture = {"a pcap or pcapng file", std::uintmax_t{1} << 20U, ""};
constexpr std::size_t kMaxRecord = 262'144;  // as libpcap and Wireshark
constexpr std::size_t kMaxBlock = kMaxRecord + 65'536;
constexpr std::size_t kMaxInterfaces = 1024;
constexpr std::uint64_t kNanoseconds = 1'000'000'000;
constexpr std::uint32_t kMagicMicro = 0xA1B2C3D4;
constexpr std::uint32_t kMagicNano = 0xA1B23C4D;
constexpr std::uint32_t kSectionBlock = 0x0A0D0D0A;
constexpr std::uint32_t kByteOrderMagic = 0x1A2B3C4D;
constexpr std::size_t kClassicHead = 24;
constexpr std::size_t kRecordHead = 16;
constexpr std::uint32_t kInterfaceBlock = 1;
constexpr std::uint32_t kSimplePacket = 3;
constexpr std::uint32_t kEnhancedPacket = 6;
constexpr std::uint64_t kTimeResolution = 9;  // option if_tsresol

/// Nanoseconds since 1970 of a count of ticks; the largest number if there is no such time.
std::int64_t stamp_of(std::uint64_t ticks, std::uint64_t ticks_per_s) {
  const std::uint64_t seconds = ticks / ticks_per_s;
  constexpr std::uint64_t kMaxSeconds = INT64_MAX / kNanoseconds - 1;
  if (seconds > kMaxSeconds) return INT64_MAX;
  const double rest = static_cast<double>(ticks % ticks_per_s) / static_cast<double>(ticks_per_s);
  return static_cast<std::int64_t>(seconds * kNanoseconds) +
         std::llround(rest * static_cast<double>(kNanoseconds));
}

}  // namespace

InputFile open_capture_file(const std::filesystem::path& path) {
  return open_input_file(path, kCapture);
}

CaptureReader::CaptureReader(const std::filesystem::path& path)
    : path_(path), file_(open_capture_file(path)) {
  if (!fill(4)) fail("fewer than 4 bytes", "a pcap or pcapng file");
  const ByteView head(buffer_.data() + begin_, 4);
  is_next_generation_ = get_big(head, 0, 4) == kSectionBlock;
  if (is_next_generation_) return;
  for (const bool is_big : {false, true}) {
    is_big_endian_ = is_big;
    const std::uint64_t magic = number(head, 0, 4);
    if (magic != kMagicMicro && magic != kMagicNano) continue;
    if (!fill(kClassicHead)) fail("an incomplete header", "24 bytes");
    const auto link =
        static_cast<std::uint16_t>(number({buffer_.data() + begin_, kClassicHead}, 20, 4));
    interfaces_ = {{link, magic == kMagicNano ? kNanoseconds : kNanoseconds / 1000}};
    begin_ += kClassicHead;
    offset_ += kClassicHead;
    return;
  }
  fail("another first number", "a pcap or pcapng file");
}

void CaptureReader::fail(const char* found, const char* allowed) const {
  throw Error({path_.string() + ", byte " + std::to_string(offset_), found, allowed});
}

std::uint64_t CaptureReader::number(std::span<const std::byte> bytes, std::size_t at,
                                    std::size_t count) const {
  return is_big_endian_ ? get_big(bytes, at, count) : get_little(bytes, at, count);
}

/// Reads until `size` unused bytes are in the buffer; false if the file ends before.
bool CaptureReader::fill(std::size_t size) {
  constexpr std::size_t kChunk = 1U << 16U;
  if (buffer_.size() - begin_ >= size) return true;
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
  begin_ = 0;
  while (buffer_.size() < size) {
    const std::size_t old = buffer_.size();
    buffer_.resize(old + kChunk);
    const std::size_t got =
        read_some(file_, path_, reinterpret_cast<char*>(buffer_.data() + old), kChunk);
    buffer_.resize(old + got);
    if (got == 0) return false;
  }
  return true;
}

bool CaptureReader::next(CaptureRecord& record) {
  return is_next_generation_ ? next_block(record) : next_classic(record);
}

bool CaptureReader::next_classic(CaptureRecord& record) {
  if (!fill(kRecordHead)) return false;
  const ByteView head(buffer_.data() + begin_, kRecordHead);
  const std::uint64_t seconds = number(head, 0, 4);
  const std::uint64_t fraction = number(head, 4, 4);
  const std::size_t size = number(head, 8, 4);
  if (size > kMaxRecord) fail("a record above 262144 bytes", "records of libpcap");
  if (!fill(kRecordHead + size)) return false;
  const std::uint64_t ticks_per_s = interfaces_.front().ticks_per_s;
  record.stamp_ns = stamp_of(seconds * ticks_per_s + fraction, ticks_per_s);
  record.link_type = interfaces_.front().link_type;
  record.bytes = {buffer_.data() + begin_ + kRecordHead, size};
  begin_ += kRecordHead + size;
  offset_ += kRecordHead + size;
  return true;
}

bool CaptureReader::next_block(CaptureRecord& record) {
  while (fill(12)) {
    const ByteView head(buffer_.data() + begin_, 12);
    if (get_big(head, 0, 4) == kSectionBlock) start_section(head);
    const auto type = static_cast<std::uint32_t>(number(head, 0, 4));
    const std::size_t size = number(head, 4, 4);
    if (size < 12 || size % 4 != 0 || size > kMaxBlock)
      fail("a block of another size", "12 to 327680 bytes, times 4");
    if (!fill(size)) return false;
    const ByteView body(buffer_.data() + begin_ + 8, size - 12);
    begin_ += size;
    offset_ += size;
    if (read_block(type, body, record)) return true;
  }
  return false;
}

void CaptureReader::start_section(std::span<const std::byte> head) {
  is_big_endian_ = get_big(head, 8, 4) == kByteOrderMagic;
  if (number(head, 8, 4) != kByteOrderMagic) fail("a section without byte order", "0x1A2B3C4D");
  interfaces_.clear();
}

void CaptureReader::add_interface(std::span<const std::byte> body) {
  if (body.size() < 8 || interfaces_.size() >= kMaxInterfaces)
    fail("an incomplete interface, or too many", "at most 1024 interfaces of a section");
  Interface made{static_cast<std::uint16_t>(number(body, 0, 2))};
  for (std::size_t at = 8; at + 4 <= body.size();) {
    const std::uint64_t code = number(body, at, 2);
    const std::size_t size = number(body, at + 2, 2);
    if (code == 0 || at + 4 + size > body.size()) break;
    if (code == kTimeResolution && size == 1) {
      const auto power = std::to_integer<unsigned>(body[at + 4]);
      made.ticks_per_s = 1;
      const unsigned factor = (power & 0x80U) != 0 ? 2 : 10;
      const unsigned count = std::min(power & 0x7FU, factor == 2 ? 40U : 12U);
      for (unsigned i = 0; i < count; ++i) made.ticks_per_s *= factor;
    }
    at += 4 + (size + 3) / 4 * 4;
  }
  interfaces_.push_back(made);
}

/// True if the block is a packet.
bool CaptureReader::read_block(std::uint32_t type, std::span<const std::byte> body,
                               CaptureRecord& record) {
  if (type == kInterfaceBlock) {
    add_interface(body);
    return false;
  }
  if (type != kEnhancedPacket && type != kSimplePacket) return false;
  const std::size_t head = type == kEnhancedPacket ? 20 : 4;
  if (body.size() < head) fail("an incomplete packet block", "its head");
  const std::size_t index = type == kEnhancedPacket ? number(body, 0, 4) : 0;
  if (index >= interfaces_.size())
    fail("a packet of an unknown interface", "interfaces of the section");
  std::size_t size = number(body, type == kEnhancedPacket ? 12 : 0, 4);
  if (type == kSimplePacket) size = std::min(size, body.size() - head);
  if (size > body.size() - head || size > kMaxRecord) fail("a packet larger than its block", "");
  const Interface& from = interfaces_[index];
  const std::uint64_t ticks =
      type == kEnhancedPacket ? (number(body, 4, 4) << 32U) | number(body, 8, 4) : 0;
  record = {stamp_of(ticks, from.ticks_per_s), from.link_type, body.subspan(head, size)};
  return true;
}

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

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::size_t kMaxRecordBytes = 262'144;

}  // namespace

PcapWriter::PcapWriter(const std::filesystem::path& path, const UdpRoute& route)
    : file_(path), route_(route) {
  Bytes head;
  put_little(head, 0xA1B2C3D4, 4);
  put_little(head, 2, 2);
  put_little(head, 4, 2);
  put_zeros(head, 8);
  put_little(head, kMaxRecordBytes, 4);
  put_little(head, static_cast<std::uint64_t>(LinkType::ethernet), 4);
  file_.write(head);
}

void PcapWriter::write(const UdpPacket& packet) {
  const std::int64_t seconds = packet.stamp_ns / kSecond;
  if (packet.stamp_ns < 0 || seconds > std::int64_t{UINT32_MAX}) {
    throw Error({file_.path().string(), "a packet at " + std::to_string(packet.stamp_ns) + " ns",
                 "times from 1970 to 2106", "let the simulation start at 0 or later"});
  }
  for (const Bytes& frame : ethernet_frames(packet, route_, id_)) {
    Bytes head;
    put_little(head, static_cast<std::uint64_t>(seconds), 4);
    put_little(head, static_cast<std::uint64_t>(packet.stamp_ns % kSecond / 1000), 4);
    put_little(head, frame.size(), 4);
    put_little(head, frame.size(), 4);
    file_.write(head);
    file_.write(frame);
  }
  ++id_;
}

bool PcapReader::next(UdpPacket& packet) {
  CaptureRecord record;
  while (records_.next(record)) {
    if (std::optional<UdpPacket> found = datagrams_.add(record)) {
      packet = std::move(*found);
      return true;
    }
  }
  return false;
}

}  // namespace glidar
