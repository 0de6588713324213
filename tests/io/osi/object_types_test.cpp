// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/osi/object_types.hpp>

#include <gtest/gtest.h>

namespace glidar::osi {
namespace {

// The numbers are those of osi_object.proto; tests/python/osi_test.py compares them with the names
// in ASAM's own package.
TEST(MovingType, OfAVehicleHasItsKind) {
  EXPECT_EQ(moving_type("truck").type, 2U);
  EXPECT_EQ(moving_type("truck").vehicle_type, 7U);
  EXPECT_EQ(moving_type("vehicle").type, 2U);
  EXPECT_EQ(moving_type("vehicle").vehicle_type, 1U);
}

TEST(MovingType, IgnoresCaseAndSeparatorsOfWords) {
  for (const char* name : {"Small Car", "small-car", "SMALL_CAR"})
    EXPECT_EQ(moving_type(name).vehicle_type, 2U) << name;
  EXPECT_EQ(moving_type("Person").type, 3U);
}

TEST(MovingType, OfUnknownNamesIsOther) {
  for (const char* name : {"", "cart", "unlabelled"}) {
    EXPECT_EQ(moving_type(name).type, 1U) << name;
    EXPECT_EQ(moving_type(name).vehicle_type, 1U) << name;
  }
}

TEST(StationaryType, IgnoresCaseAndSeparatorsOfWords) {
  EXPECT_EQ(stationary_type("Building"), 3U);
  EXPECT_EQ(stationary_type("speed bump"), 17U);
  EXPECT_EQ(stationary_type("rock"), 1U);
}

}  // namespace
}  // namespace glidar::osi
