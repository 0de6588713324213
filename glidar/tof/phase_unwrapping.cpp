// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/tof/phase_unwrapping.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/light_speed.hpp>
#include <glidar/math/unambiguous_range.hpp>

#include <algorithm>
#include <cmath>

namespace glidar::tof {
namespace {

double rounded(double value) {
  return std::floor(value + 0.5);
}

/// The range whose phases are the nearest: that of minimum variance, because phases have equal
/// errors, so that their weights are f^2.
double nearest_range_m(const Unwrapping& u, const PerFrequency& turns) {
  double along = 0.0;
  for (std::size_t f = 0; f < u.frequencies; ++f) along += turns[f] * u.per_m[f];
  return along / u.per_m_squares;
}

/// The distance of the phases from the line through 0 in the direction of the frequencies.
double misfit_rad(const Unwrapping& u, const PerFrequency& turns) {
  const double range_m = nearest_range_m(u, turns);
  double squares = 0.0;
  for (std::size_t f = 0; f < u.frequencies; ++f) {
    const double error = turns[f] - range_m * u.per_m[f];
    squares += error * error;
  }
  return kTwoPi * std::sqrt(squares);
}

/// nearest_range_m() from 0 on.
double weighted_range_m(const Unwrapping& u, const PerFrequency& turns) {
  const double range_m = nearest_range_m(u, turns);
  return range_m < 0.0 ? range_m + u.unambiguous_m : range_m;
}

/// The mean phase over the mean frequency.
double mean_range_m(const Unwrapping& u, const PerFrequency& turns) {
  double sum = 0.0;
  for (std::size_t f = 0; f < u.frequencies; ++f) sum += turns[f];
  return sum / u.per_m_sum;
}

Unwrapped best_fit(const Unwrapping& u, const PerFrequency& turns) {
  Unwrapped best = unwrap_candidate(u, turns, 0);
  for (std::size_t period = 1; period < u.periods; ++period) {
    const Unwrapped candidate = unwrap_candidate(u, turns, period);
    if (candidate.misfit_rad < best.misfit_rad) best = candidate;
  }
  return best;
}

/// In units of a thirtieth of the unambiguous range, a period of 80, 16 and 120 MHz is 3, 15 and 2
/// units. The phase of 16 MHz selects the period of 80 MHz; the parity of their position against
/// that of 120 MHz selects the half of the unambiguous range, and both select its period.
Unwrapped kinect_v2(const Unwrapping& u, const PerFrequency& turns) {
  constexpr double kHalf = 15.0;
  double fine = 3.0 * turns[0];
  double coarse = kHalf * turns[1];
  const double finest = 2.0 * turns[2];
  fine += 3.0 * rounded((coarse - fine) / 3.0);
  const double halves = 0.5 * std::abs(fine - finest);
  const double parity = 2.0 * (halves - std::floor(halves));
  if (parity > 0.5 && parity < 1.5) {
    fine += kHalf;
    coarse += kHalf;
  }
  const double finest_unwrapped = finest + 2.0 * rounded(0.5 * (fine - finest));
  Unwrapped result;
  result.turns = {fine / 3.0, coarse / kHalf, 0.5 * finest_unwrapped};
  result.range_m = mean_range_m(u, result.turns);
  result.misfit_rad = misfit_rad(u, result.turns);
  return result;
}

}  // namespace

Unwrapping make_unwrapping(const TofOptions& options) {
  const std::vector<double>& f = options.frequencies_hz;
  Unwrapping u;
  u.method = options.unwrapping;
  u.frequencies = f.size();
  u.highest = static_cast<std::size_t>(std::max_element(f.begin(), f.end()) - f.begin());
  u.unambiguous_m = unambiguous_range_m(f);
  for (std::size_t k = 0; k < f.size(); ++k) {
    u.per_m[k] = f[k] / kHalfLight_m_per_s;
    u.per_m_sum += u.per_m[k];
    u.per_m_squares += u.per_m[k] * u.per_m[k];
  }
  u.periods =
      static_cast<std::size_t>(std::max(1.0, rounded(u.unambiguous_m * u.per_m[u.highest])));
  return u;
}

Unwrapped unwrap_candidate(const Unwrapping& u, const PerFrequency& turns, std::size_t period) {
  Unwrapped result;
  const double highest = turns[u.highest] + static_cast<double>(period);
  const double range_m = highest / u.per_m[u.highest];
  for (std::size_t f = 0; f < u.frequencies; ++f) {
    result.turns[f] = turns[f] + rounded(range_m * u.per_m[f] - turns[f]);
  }
  result.turns[u.highest] = highest;
  const bool is_kinect = u.method == TofUnwrapping::kinect_v2;
  result.range_m = is_kinect ? mean_range_m(u, result.turns) : weighted_range_m(u, result.turns);
  result.misfit_rad = misfit_rad(u, result.turns);
  return result;
}

Unwrapped unwrap(const Unwrapping& u, const PerFrequency& turns) {
  return u.method == TofUnwrapping::kinect_v2 ? kinect_v2(u, turns) : best_fit(u, turns);
}

}  // namespace glidar::tof
