// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags. MCAP version 0: mcap.dev/spec (foxglove/mcap,
// website/docs/spec/index.md).

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace glidar::bags::mcap {

inline constexpr std::string_view kMagic = "\x89MCAP0\r\n";

enum class Op : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0B,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

/// Opcode and length of a record.
inline constexpr std::size_t kRecordHead = 9;
/// Of a footer's content.
inline constexpr std::size_t kFooterBytes = 20;
/// Of a message's content before its data.
inline constexpr std::size_t kMessageHead = 22;

}  // namespace glidar::bags::mcap
