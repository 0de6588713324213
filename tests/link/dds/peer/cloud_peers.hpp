// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace glidar::testing {

/// Clouds with known bytes.
struct CloudSeries {
  std::size_t count = 0;
  std::size_t bytes = 0;  ///< of the points of each
  double rate_hz = 0.0;   ///< 0: each after the acknowledgement of the previous one
};

/// Prints "matched" once there is a reader of /points. After a line of the input, writes all clouds
/// and prints their number as JSON, and after every further line the last cloud once more.
int write_clouds(const CloudSeries& series);

/// Reads clouds from /points and prints how many were complete, as JSON; ends after `count`, or
/// when the input ends.
int count_clouds(std::size_t count, std::size_t bytes);

/// Prints "matched", waits for a line of the input, and prints the numbers of the clouds that it
/// then reads from /points, up to the one with the number 0xFFFFFFFF.
int read_newest(std::size_t bytes);

}  // namespace glidar::testing
