// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/return_names.hpp>

#include <algorithm>
#include <array>

namespace glidar {
namespace {

using Order = Return::Order;

constexpr std::array<const char*, 6> kReturnNames = {"first", "second",    "third",
                                                     "last",  "strongest", "second_strongest"};
constexpr std::array<Return, kReturnNames.size()> kReturns = {{{Order::nearest, 0},
                                                               {Order::nearest, 1},
                                                               {Order::nearest, 2},
                                                               {Order::farthest, 0},
                                                               {Order::strongest, 0},
                                                               {Order::strongest, 1}}};

bool is_same(const Return& a, const Return& b) {
  return a.order == b.order && a.rank == b.rank;
}

}  // namespace

std::span<const char* const> known_return_names() {
  return kReturnNames;
}

std::vector<std::string> return_names() {
  return {kReturnNames.begin(), kReturnNames.end()};
}

Return return_named(std::string_view name) {
  const auto at = std::find(kReturnNames.begin(), kReturnNames.end(), name);
  return kReturns.at(static_cast<std::size_t>(at - kReturnNames.begin()));
}

std::vector<Return> nearest_returns(std::uint32_t count) {
  std::vector<Return> returns;
  for (unsigned k = 0; k < count; ++k) returns.push_back({Order::nearest, k});
  return returns;
}

bool are_nearest(const std::vector<Return>& returns) {
  const auto nearest = nearest_returns(static_cast<std::uint32_t>(returns.size()));
  return std::equal(returns.begin(), returns.end(), nearest.begin(), is_same);
}

std::string return_name(const Return& one) {
  for (std::size_t i = 0; i < kReturns.size(); ++i) {
    if (is_same(kReturns[i], one)) return kReturnNames[i];
  }
  return "return " + std::to_string(one.rank + 1);  // of the nearest
}

}  // namespace glidar
