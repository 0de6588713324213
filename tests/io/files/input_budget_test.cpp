// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/input_budget.hpp>

#include <support/error_text.hpp>

#include <gmock/gmock.h>

namespace glidar {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;

TEST(InputBudget, GrowsWithTheInputFromAFloor) {
  EXPECT_EQ(InputBudget(0).limit(Budget::decompressed_bytes), 256 * kMiB);
  EXPECT_EQ(InputBudget(kMiB).limit(Budget::decompressed_bytes), 512 * kMiB);
  EXPECT_EQ(InputBudget(0).limit(Budget::held_bytes), 64 * kMiB);
  EXPECT_EQ(InputBudget(1024 * kMiB).limit(Budget::held_bytes), 1024 * kMiB);
  EXPECT_GT(InputBudget(UINT64_MAX).limit(Budget::messages), UINT64_MAX / 1024);
}

TEST(InputBudget, ReportsWhatExceededItAndWhere) {
  InputBudget budget(1000);
  budget.take(Budget::topics, 5096, "run.mcap, byte 7");
  EXPECT_THAT(error_text([&] { budget.take(Budget::topics, 1, "run.mcap, byte 9"); }),
              AllOf(HasSubstr("run.mcap, byte 9: more than 5096 topics"),
                    HasSubstr("an input of 1000 bytes")));
}

TEST(InputBudget, WhatIsGivenBackCanBeTakenAgain) {
  InputBudget budget(0);
  const std::uint64_t all = budget.limit(Budget::held_bytes);
  for (int i = 0; i < 3; ++i) {
    budget.take(Budget::held_bytes, all, "a");
    budget.give_back(Budget::held_bytes, all);
  }
  EXPECT_FALSE(budget.try_take(Budget::held_bytes, all + 1));
  EXPECT_TRUE(budget.try_take(Budget::held_bytes, all));
  EXPECT_FALSE(budget.try_take(Budget::held_bytes, 1)) << "all is taken";
  EXPECT_THAT(error_text([&] { budget.take(Budget::held_bytes, UINT64_MAX, "a"); }),
              HasSubstr("bytes in memory"));
}

TEST(InputBudget, LimitsNamesOneByOneAndTogether) {
  InputBudget budget(0);
  EXPECT_THAT(error_text([&] { budget.take_name(4097, "a"); }), HasSubstr("at most 4096 bytes"));
  for (int i = 0; i < 256; ++i) budget.take_name(4096, "a");
  EXPECT_THAT(error_text([&] { budget.take_name(1, "a"); }), HasSubstr("bytes of names"));
}

}  // namespace
}  // namespace glidar
