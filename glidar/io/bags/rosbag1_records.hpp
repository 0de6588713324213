// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags. wiki.ros.org/Bags/Format/2.0.

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace glidar::bags::rosbag1 {

inline constexpr std::string_view kMagic = "#ROSBAG V2.0\n";

/// The first record is padded to this size, so that it can be replaced at the end.
inline constexpr std::size_t kBagHeaderBytes = 4096;

enum class Op : std::uint8_t {
  message = 0x02,
  bag_header = 0x03,
  index = 0x04,
  chunk = 0x05,
  chunk_info = 0x06,
  connection = 0x07,
};

}  // namespace glidar::bags::rosbag1
