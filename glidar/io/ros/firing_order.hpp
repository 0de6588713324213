// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/ros.

#include <cstdint>
#include <span>
#include <vector>

namespace glidar::ros {

/// Sorts point indices by their times, stably. A time is that of times_ns[point].
void sort_by_time(std::span<const std::uint32_t> times_ns, std::vector<std::uint32_t>& points);

}  // namespace glidar::ros
