// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/known_failures.hpp>

#include <algorithm>
#include <array>

namespace glidar {
namespace {

constexpr double kAny = -1.0;

/// A limit of the method, listed in docs/internals/accuracy.md.
struct Entry {
  std::string_view name;   ///< of the case
  std::string_view shape;  ///< empty: any
  double distance_m;       ///< kAny: any
  std::string_view reason;
  double max_wrong_share;  ///< above the measured share, because processors differ
  double max_range_error_ulp;
};

constexpr std::array<Entry, 1> kKnown = {{
    {"above a planet", "", kAny,
     "in double, the sensor's position in units of the planet's radius is exact to 1e-9 m", 0.0,
     0.1},
}};

}  // namespace

KnownFailure known_failure(const AccuracyCase& row) {
  const auto* known = std::find_if(kKnown.begin(), kKnown.end(), [&](const Entry& entry) {
    return entry.name == row.name && (entry.shape.empty() || entry.shape == row.shape) &&
           (entry.distance_m == kAny || entry.distance_m == row.distance_m);
  });
  if (known == kKnown.end()) return {};
  return {std::string(known->reason), known->max_wrong_share, known->max_range_error_ulp};
}

}  // namespace glidar
