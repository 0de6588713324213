// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/input_budget.hpp>

#include <glidar/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace glidar {
namespace {

constexpr std::uint64_t kBudgetMiB = std::uint64_t{1} << 20U;
constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

struct BudgetRule {
  const char* name;
  std::uint64_t floor;     ///< for an empty input
  std::uint64_t per_byte;  ///< of the input
  std::uint64_t max;
};

/// In the order of Budget. LZ4 expands a byte to at most 255; chunks of real bags have some MiB.
constexpr std::array<BudgetRule, 8> kRules = {{
    {"decompressed bytes", 256 * kBudgetMiB, 256, kUnlimited},
    {"bytes in memory", 64 * kBudgetMiB, 64, 1024 * kBudgetMiB},
    {"messages", 100'000, 4, kUnlimited},
    {"topics", 4096, 1, 65'536},
    {"bytes of names", kBudgetMiB, 1, 64 * kBudgetMiB},
    {"numbers of a point", 4096, 1, 65'536},
    {"values, with aliases written out", 1'000'000, 2, kUnlimited},
    {"steps of SQLite", 5'000'000, 20, kUnlimited},
}};

}  // namespace

std::uint64_t InputBudget::limit(Budget what) const {
  const BudgetRule& rule = kRules[index(what)];
  constexpr std::uint64_t kMaxInput = kUnlimited >> 10U;  // no product overflows
  return std::min(rule.max, rule.floor + rule.per_byte * std::min(input_bytes_, kMaxInput));
}

void InputBudget::take_name(std::uint64_t bytes, const std::string& place) {
  if (bytes > kMaxNameBytes) {
    throw Error({place, fmt::format("a name of {} bytes", bytes),
                 fmt::format("names of at most {} bytes", kMaxNameBytes),
                 "the file is damaged or malicious"});
  }
  take(Budget::name_bytes, bytes, place);
}

void InputBudget::fail(Budget what, const std::string& place) const {
  throw Error({place, fmt::format("more than {} {}", limit(what), kRules[index(what)].name),
               fmt::format("at most so many for an input of {} bytes", input_bytes_),
               "the file is damaged or malicious"});
}

}  // namespace glidar
