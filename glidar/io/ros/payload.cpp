// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/payload.hpp>

#include <algorithm>

namespace glidar::ros {

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
