// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/tof: the range of several phases.

#include <glidar/tof/tof_options.hpp>

#include <array>
#include <cstddef>

namespace glidar::tof {

/// A number for each frequency.
using PerFrequency = std::array<double, kMaxTofFrequencies>;

/// The frequencies and what follows from them.
struct Unwrapping {
  TofUnwrapping method = TofUnwrapping::best_fit;
  std::size_t frequencies = 0;
  std::size_t highest = 0;     ///< index of the highest frequency
  std::size_t periods = 1;     ///< of the highest frequency in the unambiguous range
  double unambiguous_m = 0.0;  ///< range after which all phases repeat
  PerFrequency per_m = {};     ///< periods per metre of range
  double per_m_sum = 0.0;      ///< sum of per_m
  double per_m_squares = 0.0;  ///< sum of per_m^2
};

/// One choice of whole periods.
struct Unwrapped {
  double range_m = 0.0;
  double misfit_rad = 0.0;  ///< distance of the phases from the line of all ranges
  PerFrequency turns = {};  ///< phases with their whole periods
};

/// Requires valid options.
Unwrapping make_unwrapping(const TofOptions& options);

/// The candidate in which the highest frequency has `period` whole periods: the other phases get
/// those that fit best. `turns` are phases in [0, 1).
Unwrapped unwrap_candidate(const Unwrapping& unwrapping, const PerFrequency& turns,
                           std::size_t period);

/// The range that the method selects.
Unwrapped unwrap(const Unwrapping& unwrapping, const PerFrequency& turns);

}  // namespace glidar::tof
