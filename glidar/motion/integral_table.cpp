// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/integral_table.hpp>

#include <glidar/math/elementary.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace glidar {
namespace {

/// Clenshaw's recurrence: the sum of c_k T_k(t).
template <std::size_t N>
double chebyshev_sum(const std::array<double, N>& c, double t) {
  double next = 0.0;
  double after = 0.0;
  for (std::size_t k = N - 1; k > 0; --k) {
    const double now = 2.0 * t * next - after + c[k];
    after = next;
    next = now;
  }
  return t * next - after + c[0];
}

/// Coefficients of a function's Chebyshev series, the first twice its own, from its values at the
/// nodes cos(pi (j + 1/2) / N); two more that are 0.
template <std::size_t N>
std::array<double, N + 2> chebyshev_series(const std::array<double, N>& values) {
  std::array<double, N + 2> series{};
  for (std::size_t k = 0; k < N; ++k) {
    for (std::size_t j = 0; j < N; ++j) {
      const double turns = static_cast<double>(k * (2 * j + 1)) / (4.0 * N);
      series[k] += 2.0 / N * values[j] * sincos_turns(turns).cosine;
    }
  }
  return series;
}

}  // namespace

IntegralTable::IntegralTable(double end, FunctionRef<double(double)> function) {
  const double count = std::max(1.0, std::ceil(end));
  const double length = end / count;
  per_segment_ = count / end;
  for (double start = 0.0; start < count; start += 1.0) {
    std::array<double, kNodes> values{};
    for (std::size_t j = 0; j < kNodes; ++j) {
      const double place = sincos_turns((static_cast<double>(j) + 0.5) / (2.0 * kNodes)).cosine;
      values[j] = function(length * (start + 0.5 * (1.0 + place)));
    }
    add_segment(length, chebyshev_series(values));
  }
}

void IntegralTable::add_segment(double length, const std::array<double, kNodes + 2>& series) {
  Segment segment{};
  double at_start = 0.0;
  double to_end = 0.0;
  for (std::size_t k = 1; k <= kNodes; ++k) {
    segment[k] = 0.25 * length * (series[k - 1] - series[k + 1]) / static_cast<double>(k);
    at_start += k % 2 == 0 ? segment[k] : -segment[k];
    to_end += segment[k];
  }
  segment[0] = total_ - at_start;
  total_ += to_end - at_start;
  segments_.push_back(segment);
}

double IntegralTable::at(double x) const {
  const double place = x * per_segment_;
  const double last = static_cast<double>(segments_.size() - 1);
  const double segment = std::clamp(std::floor(place), 0.0, last);
  return chebyshev_sum(segments_[static_cast<std::size_t>(segment)], 2.0 * (place - segment) - 1.0);
}

}  // namespace glidar
