// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/dot_product.hpp>

#include <gtest/gtest.h>

#include <random>

namespace glidar {
namespace {

TEST(DotProduct, EqualsEigensToTheBit) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto vector = [&] {
    return Eigen::Vector3d(number(generator), number(generator), number(generator));
  };
  for (int i = 0; i < 10000; ++i) {
    const Eigen::Vector3d a = vector();
    const Eigen::Vector3d b = vector();
    EXPECT_EQ(dot_product(a, b), a.dot(b));
  }
}

}  // namespace
}  // namespace glidar
