// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/frame_order.hpp>

namespace glidar::app {

std::optional<SensorFrame> FrameOrder::next() {
  std::optional<std::size_t> first;
  std::int64_t first_ns = 0;
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    if (numbers_[i] >= sensors_[i].frames) continue;
    const std::int64_t start_ns = frame_interval(sensors_[i].sensor, numbers_[i]).start_ns;
    if (first && start_ns >= first_ns) continue;
    first = i;
    first_ns = start_ns;
  }
  if (!first) return std::nullopt;
  return SensorFrame{*first, numbers_[*first]++};
}

}  // namespace glidar::app
