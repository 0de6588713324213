// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/held_messages.hpp>

#include <algorithm>
#include <utility>

namespace glidar::ros {

void HeldMessages::hold(Held message) {
  const auto is_earlier = [](std::int64_t time_ns, const Held& held) {
    return time_ns < held.time_ns;
  };
  const auto place = std::upper_bound(held_.begin(), held_.end(), message.time_ns, is_earlier);
  held_.insert(place, std::move(message));
}

std::optional<HeldMessages::Held> HeldMessages::release(std::int64_t until_ns) {
  if (held_.empty() || held_.front().time_ns > until_ns) return std::nullopt;
  Held message = std::move(held_.front());
  held_.pop_front();
  return message;
}

}  // namespace glidar::ros
