// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/frame_arrivals.hpp>

#include <algorithm>
#include <limits>

namespace glidar::ros {
namespace {

constexpr std::int64_t kAlways_ns = std::numeric_limits<std::int64_t>::max();

}  // namespace

bool FrameArrivals::add(std::size_t sensor, std::int64_t start_ns, std::int64_t duration_ns) {
  const bool is_in_order = !last_start_ns_ || start_ns >= *last_start_ns_;
  if (!is_in_order) std::fill(sensors_.begin(), sensors_.end(), SensorFrames{});
  last_start_ns_ = start_ns;
  sensors_[sensor] = {.start_ns = start_ns,
                      .next_start_ns = start_ns + duration_ns,
                      .next_end_ns = start_ns + 2 * duration_ns};
  return is_in_order;
}

std::int64_t FrameArrivals::complete_ns() const {
  if (!last_start_ns_) return std::numeric_limits<std::int64_t>::min();
  std::int64_t complete_ns = kAlways_ns;
  for (const SensorFrames& frames : sensors_) {
    const bool is_complete = is_periodic_ ? frames.start_ns.has_value()  //
                                          : frames.start_ns == last_start_ns_;
    if (!is_complete) return *last_start_ns_;
    if (is_periodic_) complete_ns = std::min(complete_ns, frames.next_start_ns);
  }
  return std::max(complete_ns, *last_start_ns_);
}

std::optional<std::int64_t> FrameArrivals::next_end_ns() const {
  std::optional<std::int64_t> end_ns;
  for (const SensorFrames& frames : sensors_) {
    if (!frames.start_ns) continue;
    end_ns = std::min(end_ns.value_or(kAlways_ns), frames.next_end_ns);
  }
  return end_ns;
}

}  // namespace glidar::ros
