// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/poisson.hpp>

#include <glidar/math/elementary.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

double invert_poisson(double mean, double uniform) {
  double probability = portable_exp(-mean);
  double sum = probability;
  double number = 0.0;
  // The terms vanish long before the limit, which only ends sums that rounding keeps below u.
  constexpr double kMaxNumber = 200.0;
  while (sum < uniform && number < kMaxNumber) {
    number += 1.0;
    probability *= mean / number;
    sum += probability;
  }
  return number;
}

}  // namespace

double sample_poisson(double mean, double uniform, double normal) {
  if (mean < kPoissonInversionLimit) return invert_poisson(mean, uniform);
  const double root = std::sqrt(mean - 1.0 / 12.0);
  const double square = normal * normal;
  const double number =
      mean + root * normal + (square - 1.0) / 6.0 + normal * (1.0 - square) / (72.0 * root);
  return std::max(0.0, std::floor(number + 0.5));
}

}  // namespace glidar
