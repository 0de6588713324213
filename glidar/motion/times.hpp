// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/motion.

#include <cstdint>

namespace glidar {

/// The seconds from one time to another, without overflow and exact to the nanosecond.
inline double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
  const auto from = static_cast<std::uint64_t>(from_ns);
  const auto to = static_cast<std::uint64_t>(to_ns);
  return to_ns >= from_ns ? static_cast<double>(to - from) / 1e9
                          : -(static_cast<double>(from - to) / 1e9);
}

}  // namespace glidar
