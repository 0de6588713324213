// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/limits.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <vector>

namespace glidar::link {
namespace {

constexpr std::int64_t kMax = 1'000'000;

constexpr std::array kKinds = {
    LimitKind{"connections", &Limits::connections, 1, kMax, "connections at each port"},
    LimitKind{"connections-per-s", &Limits::connections_per_s, 1, kMax,
              "new connections per second at each port, after a first burst of `connections`"},
    LimitKind{"handshake-s", &Limits::handshake_s, 1, 3600,
              "seconds within which a new connection completes ZeroMQ's handshake"},
    LimitKind{"request-mib", &Limits::request_mib, 1, 4096,
              "MiB of one request, and of what a client has sent of unfinished ones"},
    LimitKind{"requests", &Limits::requests, 1, kMax,
              "requests of one client that wait or whose replies it has not read"},
    LimitKind{"request-s", &Limits::request_s, 1, kMax,
              "seconds until a request is answered, and then until its reply is read"},
    LimitKind{"reply-mib", &Limits::reply_mib, 1, kMax, "MiB of one reply"},
    LimitKind{"memory-mib", &Limits::memory_mib, 1, kMax,
              "MiB of all requests that wait and all replies that are not read"},
    LimitKind{"subscriptions", &Limits::subscriptions, 1, kMax, "subscriptions of one connection"},
    LimitKind{"topic-bytes", &Limits::topic_bytes, 1, 255, "bytes of a topic"},
};

const LimitKind& kind_of(std::string_view name, std::string_view text) {
  const auto* const found = std::find_if(kKinds.begin(), kKinds.end(),
                                         [&](const LimitKind& kind) { return kind.name == name; });
  if (found != kKinds.end()) return *found;
  std::vector<std::string> names;
  std::string allowed;
  for (const LimitKind& kind : kKinds) {
    names.emplace_back(kind.name);
    allowed += (allowed.empty() ? "" : ", ") + names.back();
  }
  const std::string nearest = closest_match(std::string(name), names);
  throw Error({.where = "--limit",
               .found = "'" + std::string(text) + "'",
               .allowed = "NAME=VALUE with one of these names: " + allowed,
               .remedy = nearest.empty() ? "" : "did you mean " + nearest + "?"});
}

}  // namespace

std::span<const LimitKind> limit_kinds() {
  return kKinds;
}

void set_limit(Limits& limits, std::string_view text) {
  const std::size_t equals = text.find('=');
  const LimitKind& kind = kind_of(text.substr(0, equals), text);
  const std::string_view number =
      equals == std::string_view::npos ? std::string_view() : text.substr(equals + 1);
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || stop != number.data() + number.size() || value < kind.min ||
      value > kind.max) {
    throw Error({.where = "--limit " + std::string(kind.name),
                 .found = "'" + std::string(number) + "'",
                 .allowed = "a whole number from " + std::to_string(kind.min) + " to " +
                            std::to_string(kind.max) + ": " + std::string(kind.meaning),
                 .remedy = "for example --limit " + std::string(kind.name) + "=" +
                           std::to_string(Limits{}.*kind.value)});
  }
  limits.*kind.value = value;
}

std::string limit_text(const Limits& limits, std::int64_t Limits::*value) {
  const auto* const kind = std::find_if(kKinds.begin(), kKinds.end(),
                                        [&](const LimitKind& one) { return one.value == value; });
  return "at most " + std::to_string(limits.*value) + " (--limit " + std::string(kind->name) + ")";
}

}  // namespace glidar::link
