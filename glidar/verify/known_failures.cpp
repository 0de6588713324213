// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/known_failures.hpp>

#include <algorithm>
#include <array>

namespace glidar {
namespace {

/// A limit of the method, listed in docs/accuracy.md.
struct KnownFailure {
  std::string_view name;   ///< of the case
  std::string_view shape;  ///< empty: any
  double distance_m;       ///< kAny: any
  bool is_of_rays_only;    ///< of Embree's rays: not of what draws pinhole cameras
  std::string_view reason;
};

constexpr double kAny = -1.0;

constexpr std::array<KnownFailure, 6> kKnown = {{
    {"several instances", "", 1e4, true,
     "rays are traced in single precision of the distance between the instances"},
    {"several instances", "", 1e5, true,
     "rays are traced in single precision of the distance between the instances"},
    {"above a planet", "", kAny, true,
     "rays start 6 m beside the sensor, below the ground: 2^-20 of the radius"},
    {"above a planet", "", kAny, false,
     "in double, the sensor's place in units of the planet's radius is known to 1e-9 m"},
    {"sensor on a vertex", "tetrahedron", kAny, false,
     "in double, faces at the sensor's vertex may be 1e-16 m in front of it"},
    {"beside the outline", "", kAny, true,
     "rays are traced 2^-20 of the scene's radius beside their beams"},
}};

}  // namespace

std::string known_failure(std::string_view renderer, const VerifyRow& row) {
  const bool casts_rays = renderer == "embree" || renderer == "auto";
  const auto* known = std::find_if(kKnown.begin(), kKnown.end(), [&](const KnownFailure& failure) {
    return failure.name == row.name && (failure.shape.empty() || failure.shape == row.shape) &&
           (failure.distance_m == kAny || failure.distance_m == row.distance_m) &&
           (casts_rays || !failure.is_of_rays_only);
  });
  return known == kKnown.end() ? std::string() : std::string(known->reason);
}

}  // namespace glidar
