// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/screen.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glidar::app {
namespace {

TEST(ShownNumbers, NumbersThatRoundToZeroHaveNoSign) {
  for (const double value : {-0.0, 0.0, -0.001, -1e-9, -0.0049, -5e-324}) {
    EXPECT_FALSE(std::signbit(rounded(value, 2))) << value;
    EXPECT_EQ(fmt::format("{:.2f}", rounded(value, 2)), "0.00") << value;
  }
}

TEST(ShownNumbers, OtherNumbersAreRoundedHalfAwayFromZero) {
  EXPECT_EQ(rounded(-0.005, 2), -0.01);
  EXPECT_EQ(rounded(2.5, 0), 3.0);
  EXPECT_EQ(rounded(-2.5, 0), -3.0);
  EXPECT_EQ(rounded(0.1234564, 6), 0.123456);
  EXPECT_EQ(rounded(-179.996, 2), -180.0);
}

TEST(ShownNumbers, IntegersAndNonFiniteNumbersAreUnchanged) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double value : {1e15, -1e15, 1e300, kInfinity, -kInfinity}) {
    EXPECT_EQ(rounded(value, 6), value);
  }
  EXPECT_TRUE(std::isnan(rounded(std::nan(""), 2)));
}

TEST(ShownNumbers, ZerosInTextLoseTheirMinusSign) {
  EXPECT_EQ(without_negative_zeros("-0.00"), "0.00");
  EXPECT_EQ(without_negative_zeros("(-0, 1, -0.0) m"), "(0, 1, 0.0) m");
  EXPECT_EQ(without_negative_zeros("at -0"), "at 0");
  EXPECT_EQ(without_negative_zeros("moved by -0.000."), "moved by 0.000.");
}

TEST(ShownNumbers, OtherMinusSignsAndHyphensAreUnchanged) {
  for (const char* text : {"-0.01", "-1", "(-10, -0.5)", "1e-09", "1-0", "moon-0", "-0x1F", "-0m",
                           "a - b", "-", "", "2026-01-00", "--sensor-name"}) {
    EXPECT_EQ(without_negative_zeros(text), text);
  }
}

}  // namespace
}  // namespace glidar::app
