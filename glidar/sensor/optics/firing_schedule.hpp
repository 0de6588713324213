// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

namespace glidar {

/// The stretch of time that one frame covers, [start_ns, end_ns). A sensor that fires without pause
/// gives a frame the beams it fires in there, so that successive frames join without gap or overlap
/// whatever their length. A camera exposes all of its pixels at start_ns.
struct FrameInterval {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
};

/// Events that repeat for ever: number k is at first_ns + k period_ns, k = 0 the first one of all
/// time that matters, negative k before it.
struct FiringSchedule {
  double first_ns = 0.0;
  double period_ns = 1.0;
};

/// Numbers of the ticks in a window: [begin, end).
struct FiringRange {
  std::int64_t begin = 0;
  std::int64_t end = 0;

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(end - begin); }
};

/// When tick k is, to the nanosecond.
std::int64_t firing_time_ns(const FiringSchedule& ticks, std::int64_t k);

/// The ticks in a window. Each tick is in one of two adjoining windows.
/// Throws Error when the window is longer than beam times can count (4.29 s), ends before it
/// starts, or lies more than 100 days from zero, and when it has more than `most` ticks.
FiringRange firings_in(const FiringSchedule& ticks, const FrameInterval& window, std::size_t most);

/// The unit vector at these angles: azimuth from +x to the left, elevation from the horizon up.
Eigen::Vector3d direction_at(double azimuth_rad, double elevation_rad);

/// The most beams that one window may have.
inline constexpr std::size_t kMaxBeams = std::size_t{1} << 27U;

}  // namespace glidar
