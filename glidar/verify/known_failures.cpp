// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/known_failures.hpp>

#include <algorithm>
#include <array>

namespace glidar {
namespace {

constexpr double kAny = -1.0;

/// A limit of the method, listed in docs/accuracy.md.
struct Entry {
  std::string_view name;   ///< of the case
  std::string_view shape;  ///< empty: any
  double distance_m;       ///< kAny: any
  bool is_of_rays_only;    ///< of Embree's rays: not of what draws pinhole cameras
  std::string_view reason;
  double max_wrong_share;  ///< above what is measured, since processors differ
  double max_range_error_ulp;
};

constexpr std::array<Entry, 6> kKnown = {{
    {"several instances", "", 1e4, true,
     "rays are traced in single precision of the distance between the instances", 1e-4, 10.0},
    {"several instances", "", 1e5, true,
     "rays are traced in single precision of the distance between the instances", 5e-4, 10.0},
    {"above a planet", "", kAny, true,
     "rays start 6 m beside the sensor, below the ground: 2^-20 of the radius", 0.75,
     1.2e14},  // the planet's diameter
    {"above a planet", "", kAny, false,
     "in double, the sensor's place in units of the planet's radius is known to 1e-9 m", 0.0, 0.1},
    {"sensor on a vertex", "tetrahedron", kAny, false,
     "in double, faces at the sensor's vertex may be 1e-16 m in front of it", 0.03,
     kRangeBound_ulp},
    {"beside the outline", "", kAny, true,
     "rays are traced 2^-20 of the scene's radius beside their beams", 0.4, 500.0},
}};

}  // namespace

KnownFailure known_failure(std::string_view renderer, const VerifyRow& row) {
  const bool casts_rays = renderer == "embree" || renderer == "auto";
  const auto* known = std::find_if(kKnown.begin(), kKnown.end(), [&](const Entry& entry) {
    return entry.name == row.name && (entry.shape.empty() || entry.shape == row.shape) &&
           (entry.distance_m == kAny || entry.distance_m == row.distance_m) &&
           (casts_rays || !entry.is_of_rays_only);
  });
  if (known == kKnown.end()) return {};
  return {std::string(known->reason), known->max_wrong_share, known->max_range_error_ulp};
}

}  // namespace glidar
