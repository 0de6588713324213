// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/held_messages.hpp>

#include <algorithm>
#include <utility>

namespace glidar::ros {
namespace {

/// Memory of smaller messages is not worth keeping.
constexpr std::size_t kLarge_bytes = 65'536;

}  // namespace

std::vector<std::byte> HeldMessages::take_memory(std::size_t size) {
  if (size < kLarge_bytes) return {};
  auto best = spare_.end();
  for (auto memory = spare_.begin(); memory != spare_.end(); ++memory) {
    const bool fits = memory->capacity() >= size;
    if (fits && (best == spare_.end() || memory->capacity() < best->capacity())) best = memory;
  }
  if (best == spare_.end()) return {};
  std::vector<std::byte> memory = std::move(*best);
  spare_.erase(best);
  return memory;
}

void HeldMessages::give_back(std::vector<std::byte> memory) {
  constexpr std::size_t kMaxSpare = 8;
  if (memory.capacity() < kLarge_bytes) return;
  if (spare_.size() == kMaxSpare) spare_.erase(spare_.begin());
  spare_.push_back(std::move(memory));
}

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
