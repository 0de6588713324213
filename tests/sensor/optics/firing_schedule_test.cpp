// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/firing_schedule.hpp>

#include <glidar/math/constants.hpp>
#include <tests/support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace glidar {
namespace {

using ::testing::HasSubstr;

constexpr double kHundredDays_ns = 8.64e15;
constexpr std::size_t kMany = 1000;

std::string error_of(const FiringSchedule& ticks) {
  return error_text([&] { firings_in(ticks, {0, 100'000'000}, kMany); });
}

/// At the largest of these times a step of one tick is lost in rounding, and a search for the first
/// tick would not end.
TEST(FiringSchedule, PeriodsBeyondAHundredDaysAreErrors) {
  for (const double period_ns :
       {8.65e15, 9.3e18, 1e21, 1e300, std::numeric_limits<double>::infinity(), kNaN, 0.5, -1.0}) {
    EXPECT_THAT(error_of({0.0, period_ns}), HasSubstr("optics, period")) << period_ns;
  }
  for (const double first_ns : {1e21, -1e21, kNaN})
    EXPECT_THAT(error_of({first_ns, 100.0}), HasSubstr("optics, first time")) << first_ns;
}

TEST(FiringSchedule, TheLongestPeriodIsExact) {
  const FiringSchedule ticks{50.0, kHundredDays_ns};
  EXPECT_EQ(firings_in(ticks, {0, 100}, kMany).size(), 1U);
  EXPECT_EQ(firings_in(ticks, {51, 100}, kMany).size(), 0U);
  const FiringSchedule last{kHundredDays_ns, kHundredDays_ns};
  EXPECT_EQ(firings_in(last, {0, 1}, kMany).size(), 1U);
}

}  // namespace
}  // namespace glidar
