// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/capture_reader.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/packet_bytes.hpp>

#include <algorithm>
#include <cmath>
#include <string>

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

}  // namespace glidar
