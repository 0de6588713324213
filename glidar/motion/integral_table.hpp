// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/motion.

#include <glidar/core/function_ref.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace glidar {

/// The integral of a smooth function from 0 to x, for x in [0, end]: Chebyshev series over segments
/// of length at most 1, integrated term by term (Clenshaw and Curtis, Numer. Math. 2 (1960) 197).
/// Exact to rounding for a function without poles within 1.5 of the segments.
class IntegralTable {
 public:
  IntegralTable() = default;
  IntegralTable(double end, FunctionRef<double(double)> function);

  /// The integral from 0 to x, for x in [0, end].
  [[nodiscard]] double at(double x) const;

  /// The integral from 0 to the end.
  [[nodiscard]] double total() const { return total_; }

 private:
  static constexpr std::size_t kNodes = 20;  // (pi + sqrt(1 + pi^2))^-20 = 1e-16

  /// The integral up to the segment's start, and the coefficients of the integral from there.
  using Segment = std::array<double, kNodes + 1>;

  /// Appends a segment: the integral of a Chebyshev series.
  void add_segment(double length, const std::array<double, kNodes + 2>& series);

  double per_segment_ = 0.0;  ///< 1 / length
  double total_ = 0.0;
  std::vector<Segment> segments_;
};

}  // namespace glidar
