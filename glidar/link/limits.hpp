// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace glidar::link {

/// Limits of peers, for each or for all together. limit_kinds() describes each.
struct Limits {
  std::int64_t connections = 256;
  std::int64_t connections_per_s = 500;
  std::int64_t handshake_s = 5;
  std::int64_t request_mib = 16;
  std::int64_t requests = 16;
  std::int64_t request_s = 600;
  std::int64_t reply_mib = 1024;
  std::int64_t memory_mib = 2048;
  std::int64_t subscriptions = 64;
  std::int64_t topic_bytes = 64;

  bool operator==(const Limits&) const = default;
};

/// One limit: its name, range and description.
struct LimitKind {
  std::string_view name;
  std::int64_t Limits::*value;
  std::int64_t min;
  std::int64_t max;
  std::string_view meaning;
};

/// All limits, in the order of the members.
std::span<const LimitKind> limit_kinds();

/// Sets a limit by "NAME=VALUE", for example "reply-mib=4096". Throws Error for an unknown name and
/// for a value that is not an integer in its range.
void set_limit(Limits& limits, std::string_view text);

/// "at most 16 (--limit requests=16)", for errors.
std::string limit_text(const Limits& limits, std::int64_t Limits::*value);

constexpr std::int64_t bytes_of_mib(std::int64_t mib) {
  return mib << 20;
}

}  // namespace glidar::link
