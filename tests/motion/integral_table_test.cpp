// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/integral_table.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

TEST(IntegralTable, IntegratesSmoothFunctionsToRounding) {
  // the pole nearest to the real axis is at a distance of pi / 2, as that of sech
  const auto sech = [](double x) { return 1.0 / std::cosh(x); };
  for (const double end : {0.1, 1.0, 1.7, 40.3}) {
    const IntegralTable table(end, FunctionRef<double(double)>(sech));
    for (int k = 0; k <= 100; ++k) {
      const double x = end * k / 100;
      EXPECT_NEAR(table.at(x), std::atan(std::sinh(x)), 2e-15) << end << " " << x;
    }
    EXPECT_NEAR(table.total(), std::atan(std::sinh(end)), 2e-15);
  }
}

TEST(IntegralTable, IsZeroAtTheStart) {
  const auto one = [](double) { return 1.0; };
  EXPECT_NEAR(IntegralTable(3.0, FunctionRef<double(double)>(one)).at(0.0), 0.0, 1e-16);
}

}  // namespace
}  // namespace glidar
