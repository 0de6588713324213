// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/motion.

#include <glidar/core/error.hpp>

#include <cstdint>

namespace glidar {

/// The seconds from one time to another, without overflow; exact to the nanosecond up to 104 days,
/// to 1024 ns at most.
inline double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
  const auto from = static_cast<std::uint64_t>(from_ns);
  const auto to = static_cast<std::uint64_t>(to_ns);
  return to_ns >= from_ns ? static_cast<double>(to - from) / 1e9
                          : -(static_cast<double>(from - to) / 1e9);
}

/// A time on another clock, which shows `to_ns` when this one shows `from_ns`. Throws Error if it
/// leaves the range of nanoseconds.
inline std::int64_t shifted_time_ns(std::int64_t t_ns, std::int64_t from_ns, std::int64_t to_ns) {
  std::int64_t shifted_ns = 0;
  if (!__builtin_sub_overflow(t_ns, from_ns, &shifted_ns) &&
      !__builtin_add_overflow(shifted_ns, to_ns, &shifted_ns)) {
    return shifted_ns;
  }
  throw Error({"trajectory", "times that leave the range of nanoseconds when shifted",
               "times within 290 years"});
}

}  // namespace glidar
