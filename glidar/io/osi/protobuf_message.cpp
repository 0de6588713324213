// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/osi/protobuf_message.hpp>

#include <glidar/core/text.hpp>

#include <bit>
#include <cstddef>

namespace glidar {
namespace {

/// How the value of a field is encoded.
enum class WireType : std::uint8_t { varint = 0, fixed64 = 1, length_delimited = 2 };

std::uint64_t tag(std::uint32_t field, WireType type) {
  constexpr unsigned kTypeBits = 3;
  return std::uint64_t{field} << kTypeBits | static_cast<std::uint64_t>(type);
}

}  // namespace

void ProtobufMessage::varint(std::uint64_t value) {
  constexpr std::uint64_t kContinues = 0x80;
  constexpr unsigned kBits = 7;
  for (; value >= kContinues; value >>= kBits)
    bytes_ += static_cast<char>((value & (kContinues - 1)) | kContinues);
  bytes_ += static_cast<char>(value);
}

ProtobufMessage& ProtobufMessage::integer(std::uint32_t field, std::uint64_t value) {
  varint(tag(field, WireType::varint));
  varint(value);
  return *this;
}

ProtobufMessage& ProtobufMessage::integer(std::uint32_t field, std::int64_t value) {
  return integer(field, static_cast<std::uint64_t>(value));
}

ProtobufMessage& ProtobufMessage::real(std::uint32_t field, double value) {
  varint(tag(field, WireType::fixed64));
  const auto bits = std::bit_cast<std::uint64_t>(value);
  for (unsigned shift = 0; shift < 64; shift += 8)
    bytes_ += static_cast<char>(bits >> shift & 0xFF);
  return *this;
}

ProtobufMessage& ProtobufMessage::bytes(std::uint32_t field, std::string_view value) {
  varint(tag(field, WireType::length_delimited));
  varint(value.size());
  bytes_ += value;
  return *this;
}

ProtobufMessage& ProtobufMessage::text(std::uint32_t field, std::string_view value) {
  std::string valid;
  while (!value.empty()) {
    const std::size_t size = utf8_size(value);
    valid += size == 0 ? "?" : value.substr(0, size);
    value.remove_prefix(size == 0 ? 1 : size);
  }
  return bytes(field, valid);
}

ProtobufMessage& ProtobufMessage::message(std::uint32_t field, const ProtobufMessage& value) {
  return bytes(field, value.bytes());
}

}  // namespace glidar
