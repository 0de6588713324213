// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/messages.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <limits>

namespace glidar::ros {

Time time_from_ns(std::int64_t t_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  std::int64_t sec = t_ns / kSecond_ns;
  std::int64_t nanosec = t_ns % kSecond_ns;
  if (nanosec < 0) {
    nanosec += kSecond_ns;
    --sec;
  }
  using Sec = std::numeric_limits<std::int32_t>;
  if (sec < Sec::min() || sec > Sec::max()) {
    throw Error({"stamp of a ROS message", std::to_string(t_ns) + " ns",
                 "from -2147483648 s to 2147483647 s, the years 1901 to 2038",
                 "start at another time"});
  }
  return {static_cast<std::int32_t>(sec), static_cast<std::uint32_t>(nanosec)};
}

std::int64_t to_ns(const Time& time) {
  return std::int64_t{time.sec} * 1'000'000'000 + time.nanosec;
}

void Payload::write_to(std::span<std::byte> to) const {
  if (write_) return write_(to.first(size_));
  std::copy(bytes_.begin(), bytes_.end(), to.begin());
}

std::vector<std::byte> Payload::to_vector() const {
  if (!write_) return bytes_;
  std::vector<std::byte> bytes(size_);
  write_(bytes);
  return bytes;
}

}  // namespace glidar::ros
