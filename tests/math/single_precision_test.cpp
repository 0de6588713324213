// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/single_precision.hpp>

#include <gtest/gtest.h>
#include <Eigen/Core>

namespace glidar {
namespace {

/// Not inlined, so that the compiler cannot see the numbers.
[[gnu::noinline]] Eigen::Vector3d rounded(const Eigen::Vector3d& v) {
  return {rounded_to_float(v[0]), rounded_to_float(v[1]), rounded_to_float(v[2])};
}

[[gnu::noinline]] Eigen::Vector3d rounded_by_expression(const Eigen::Vector3d& v) {
  return v.unaryExpr(&rounded_to_float);
}

// This file is compiled with -O3, where GCC 12 leaves two of the three roundings out of plain
// conversions in the first of these functions.
TEST(SinglePrecision, AdjacentNumbersAreRoundedLikeSingleNumbers) {
  const Eigen::Vector3d v(0.1, 1.0e10 / 3.0, -0.3);
  EXPECT_EQ(rounded(v), Eigen::Vector3d(double{0.1F}, double{3333333248.0F}, double{-0.3F}));
  EXPECT_EQ(rounded_by_expression(v), rounded(v));
  EXPECT_EQ(rounded({0.5, -2.0, 0.0}), Eigen::Vector3d(0.5, -2.0, 0.0));
}

}  // namespace
}  // namespace glidar
