// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/imu.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace glidar {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> values_of(const BiasProcess& process, std::uint64_t first,
                                std::size_t count) {
  std::vector<Vector3d> values(count, Vector3d::Zero());
  add_process(process, {.seed = 5}, first, values);
  return values;
}

/// The mean of a product over all axes, and its standard error for independent terms.
struct Moment {
  double sum = 0.0;
  double count = 0.0;
  void add(double product) {
    sum += product;
    count += 1.0;
  }
  [[nodiscard]] double mean() const { return sum / count; }
};

TEST(RandomWalk, StartsAtZeroAndHasIndependentIncrementsOfTheRightSize) {
  constexpr std::size_t kCount = 100'000;
  const std::vector<Vector3d> values = values_of(random_walk(3.0, 4.0), 0, kCount);
  EXPECT_EQ(values[0], Vector3d::Zero());
  Moment variance;
  Moment covariance;
  for (std::size_t i = 2; i < kCount; ++i) {
    const Vector3d step = values[i] - values[i - 1];
    const Vector3d before = values[i - 1] - values[i - 2];
    for (int axis = 0; axis < 3; ++axis) {
      variance.add(step[axis] * step[axis]);
      covariance.add(step[axis] * before[axis]);
    }
  }
  const double expected = 9.0 / 4.0;
  const double sigmas = 5.0 / std::sqrt(variance.count);
  EXPECT_NEAR(variance.mean(), expected, sigmas * std::sqrt(2.0) * expected);
  EXPECT_NEAR(covariance.mean(), 0.0, sigmas * expected);
}

TEST(CorrelatedProcess, HasItsVarianceAndCorrelation) {
  constexpr std::size_t kCount = 200'000;
  constexpr double kTime_s = 0.5;
  constexpr double kRate_hz = 10.0;
  const std::vector<Vector3d> values =
      values_of(correlated_process(2.0, kTime_s, kRate_hz), 1'000'000, kCount);
  for (const std::size_t lag : {0U, 1U, 5U, 12U}) {
    Moment moment;
    for (std::size_t i = lag; i < kCount; ++i) {
      for (int axis = 0; axis < 3; ++axis) moment.add(values[i][axis] * values[i - lag][axis]);
    }
    const double expected = 4.0 * std::exp(-static_cast<double>(lag) / (kRate_hz * kTime_s));
    // about kRate kTime samples depend on each other
    const double error = 5.0 * 4.0 * std::sqrt(2.0 * kRate_hz * kTime_s / moment.count);
    EXPECT_NEAR(moment.mean(), expected, error) << lag;
  }
}

TEST(BiasProcess, ValuesDependOnTheSampleNumberOnly) {
  const BiasProcess process = correlated_process(1.0, 100.0, 200.0);
  const std::uint64_t far = (std::uint64_t{1} << 39U) - 20;
  const std::vector<Vector3d> all = values_of(process, far, 40);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(values_of(process, far + i, 1)[0], all[i]);
  }
}

TEST(BiasProcess, AxesAreIndependent) {
  const std::vector<Vector3d> values = values_of(random_walk(1.0, 1.0), 0, 50'000);
  Moment covariance;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const Vector3d step = values[i] - values[i - 1];
    covariance.add(step[0] * step[1]);
    covariance.add(step[1] * step[2]);
  }
  EXPECT_NEAR(covariance.mean(), 0.0, 5.0 / std::sqrt(covariance.count));
}

}  // namespace
}  // namespace glidar
