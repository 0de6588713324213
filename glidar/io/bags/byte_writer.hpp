// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace glidar::bags {

static_assert(std::endian::native == std::endian::little, "bags are little-endian");

using Bytes = std::vector<std::byte>;

inline void append(Bytes& to, std::span<const std::byte> bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

template <class Number>
requires std::is_integral_v<Number>
void append(Bytes& to, Number value) {
  append(to, std::as_bytes(std::span(&value, 1)));
}

/// The characters alone.
inline void append(Bytes& to, std::string_view text) {
  append(to, std::as_bytes(std::span(text)));
}

/// A count of bytes as u32, and the bytes.
inline void append_sized(Bytes& to, std::span<const std::byte> bytes) {
  append(to, static_cast<std::uint32_t>(bytes.size()));
  append(to, bytes);
}

inline void append_sized(Bytes& to, std::string_view text) {
  append_sized(to, std::as_bytes(std::span(text)));
}

/// Replaces a number that was appended before.
template <class Number>
void replace(Bytes& in, std::size_t at, Number value) {
  std::memcpy(in.data() + at, &value, sizeof value);
}

}  // namespace glidar::bags
