// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io and glidar/link: numbers in packets.

#include <glidar/core/error.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace glidar {

using Bytes = std::vector<std::byte>;
using ByteView = std::span<const std::byte>;

/// Byte `index` of a number, counted from the lowest; 0 above its eight bytes.
inline std::byte byte_of(std::uint64_t value, std::size_t index) {
  return index < sizeof value ? static_cast<std::byte>(value >> (8 * index)) : std::byte{0};
}

/// Appends the low `count` bytes of a number, the lowest first.
inline void put_little(Bytes& bytes, std::uint64_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) bytes.push_back(byte_of(value, i));
}

/// Appends the low `count` bytes of a number, the highest first.
inline void put_big(Bytes& bytes, std::uint64_t value, std::size_t count) {
  for (std::size_t i = count; i-- > 0;) bytes.push_back(byte_of(value, i));
}

inline void put_float(Bytes& bytes, float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  put_little(bytes, bits, sizeof bits);
}

inline void put_zeros(Bytes& bytes, std::size_t count) {
  bytes.resize(bytes.size() + count);
}

/// The number in `count` bytes at an offset, the lowest byte first. The caller has checked the
/// size.
inline std::uint64_t get_little(ByteView bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value |= std::to_integer<std::uint64_t>(bytes[at + i]) << (8 * i);
  return value;
}

/// The same, the highest byte first.
inline std::uint64_t get_big(ByteView bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value = (value << 8U) | std::to_integer<std::uint64_t>(bytes[at + i]);
  return value;
}

template <std::unsigned_integral T>
T get(ByteView bytes, std::size_t at) {
  return static_cast<T>(get_little(bytes, at, sizeof(T)));
}

inline float get_float(ByteView bytes, std::size_t at) {
  const auto bits = get<std::uint32_t>(bytes, at);
  float value = 0.0F;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// Throws Error unless a packet has this size.
inline void require_packet_size(ByteView bytes, std::size_t size, const char* packet) {
  if (bytes.size() == size) return;
  throw Error({packet, std::to_string(bytes.size()) + " bytes", std::to_string(size) + " bytes"});
}

}  // namespace glidar
