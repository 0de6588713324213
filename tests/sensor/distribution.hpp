// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Tests of distributions. With fixed seeds the result is deterministic; a correct sample exceeds
// the limits once in 10000.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace glidar::testing {

/// Of Kolmogorov's distribution: 2 exp(-2 x^2) = 1e-4.
inline constexpr double kKolmogorovLimit = 2.2253;

/// sqrt(n) times the largest distance from the uniform distribution on 0..1.
inline double kolmogorov(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto before = static_cast<double>(i);
    largest = std::max({largest, (before + 1.0) / n - values[i], values[i] - before / n});
  }
  return values.empty() ? std::numeric_limits<double>::infinity() : std::sqrt(n) * largest;
}

/// The same for two samples.
inline double kolmogorov(std::vector<double> one, std::vector<double> other) {
  std::sort(one.begin(), one.end());
  std::sort(other.begin(), other.end());
  const auto n = static_cast<double>(one.size());
  const auto m = static_cast<double>(other.size());
  double largest = 0.0;
  std::size_t j = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    while (j < other.size() && other[j] <= one[i]) ++j;
    largest = std::max(largest,
                       std::abs((static_cast<double>(i) + 1.0) / n - static_cast<double>(j) / m));
  }
  return largest * std::sqrt(n * m / (n + m));
}

inline double chi_square(std::span<const double> found, std::span<const double> expected) {
  double sum = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    sum += (found[i] - expected[i]) * (found[i] - expected[i]) / expected[i];
  }
  return sum;
}

/// By Wilson and Hilferty, PNAS 17 (1931) 684.
inline double chi_square_limit(double freedom) {
  constexpr double kNormal = 3.719;  // exceeded once in 10000
  const double part = 2.0 / (9.0 * freedom);
  return freedom * std::pow(1.0 - part + kNormal * std::sqrt(part), 3.0);
}

}  // namespace glidar::testing
