// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

namespace glidar {

/// The time interval of one frame, [start_ns, end_ns). The frame of a sensor that fires
/// continuously has the beams fired in it, so that successive frames join without gap or overlap. A
/// camera exposes all pixels at start_ns.
struct FrameInterval {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
};

/// Periodic events: number k, which may be negative, is at first_ns + k period_ns.
struct FiringSchedule {
  double first_ns = 0.0;
  double period_ns = 1.0;
};

/// The numbers [begin, end) of the events in an interval.
struct FiringRange {
  std::int64_t begin = 0;
  std::int64_t end = 0;

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(end - begin); }
};

/// Time of event k, rounded to nanoseconds.
std::int64_t firing_time_ns(const FiringSchedule& schedule, std::int64_t k);

/// The events in an interval. Every event is in exactly one of two adjacent intervals.
/// Throws Error if the interval is longer than beam times can represent (4.29 s), ends before it
/// starts, is more than 100 days from zero, or has more than `max` events.
FiringRange firings_in(const FiringSchedule& schedule, const FrameInterval& interval,
                       std::size_t max);

/// The unit vector at these angles: azimuth from +x towards +y, elevation towards +z.
Eigen::Vector3d direction_at(double azimuth_rad, double elevation_rad);

/// The maximum number of beams in one interval.
inline constexpr std::size_t kMaxBeams = std::size_t{1} << 27U;

}  // namespace glidar
