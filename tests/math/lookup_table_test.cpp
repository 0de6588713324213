// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/lookup_table.hpp>

#include <gtest/gtest.h>

namespace glidar {
namespace {

TEST(LookupTable, IsLinearBetweenEntriesAndConstantOutside) {
  const LookupTable table = {{1.0, 0.2}, {3.0, 0.6}, {4.0, 0.0}};
  EXPECT_EQ(interpolate(table, 0.0), 0.2);
  EXPECT_EQ(interpolate(table, 1.0), 0.2);
  EXPECT_DOUBLE_EQ(interpolate(table, 2.0), 0.4);
  EXPECT_EQ(interpolate(table, 3.0), 0.6);
  EXPECT_DOUBLE_EQ(interpolate(table, 3.5), 0.3);
  EXPECT_EQ(interpolate(table, 9.0), 0.0);
}

TEST(LookupTable, WithOneEntryIsConstant) {
  EXPECT_EQ(interpolate({{5.0, 0.7}}, -1.0), 0.7);
  EXPECT_EQ(interpolate({{5.0, 0.7}}, 9.0), 0.7);
}

TEST(LookupTable, WithoutEntriesReturnsTheDefault) {
  EXPECT_EQ(interpolate({}, 9.0), 0.0);
  EXPECT_EQ(interpolate({}, 9.0, 1.5), 1.5);
}

}  // namespace
}  // namespace glidar
