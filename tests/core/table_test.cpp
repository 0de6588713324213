// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/table.hpp>

#include <gtest/gtest.h>

namespace glidar {
namespace {

TEST(Table, IsStraightBetweenAndConstantOutside) {
  const Table table = {{1.0, 0.2}, {3.0, 0.6}, {4.0, 0.0}};
  EXPECT_EQ(look_up(table, 0.0), 0.2);
  EXPECT_EQ(look_up(table, 1.0), 0.2);
  EXPECT_DOUBLE_EQ(look_up(table, 2.0), 0.4);
  EXPECT_EQ(look_up(table, 3.0), 0.6);
  EXPECT_DOUBLE_EQ(look_up(table, 3.5), 0.3);
  EXPECT_EQ(look_up(table, 9.0), 0.0);
}

TEST(Table, OfOnePairIsConstant) {
  EXPECT_EQ(look_up({{5.0, 0.7}}, -1.0), 0.7);
  EXPECT_EQ(look_up({{5.0, 0.7}}, 9.0), 0.7);
}

TEST(Table, WithoutPairsGivesWhatTheCallerSays) {
  EXPECT_EQ(look_up({}, 9.0), 0.0);
  EXPECT_EQ(look_up({}, 9.0, 1.5), 1.5);
}

}  // namespace
}  // namespace glidar
