// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/decimal_text.hpp>
#include <glidar/math/constants.hpp>

#include <gtest/gtest.h>

namespace glidar {
namespace {

TEST(DecimalText, HasTheRequestedNumberOfDecimals) {
  EXPECT_EQ(decimal_text(3.14159), "3.14");
  EXPECT_EQ(decimal_text(-0.0625, 3), "-0.063");
  EXPECT_EQ(decimal_text(2.005, 0), "2");
  EXPECT_EQ(decimal_text(-0.001), "0.00");
  EXPECT_EQ(decimal_text(1234567.5, 1), "1234567.5");
}

TEST(DecimalText, NamesWhatIsNoNumber) {
  EXPECT_EQ(decimal_text(kNaN), "none");
  EXPECT_EQ(decimal_text(kInfinity), "none");
}

}  // namespace
}  // namespace glidar
