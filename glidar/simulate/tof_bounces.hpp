// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/tof_light.hpp>

namespace glidar {

/// Adds the light of the illuminator that reaches the pixels' surfaces over diffuse bounces. Each
/// pixel has bounce_rays paths: from a surface that the pixel sees they leave in directions with
/// the density cosine / pi; what they meet, and an illuminator ray shows to be lit, sends back A
/// rho_1 rho_2 cosine / R^2, divided by the number of paths, with the phase of the whole way. Paths
/// continue from there for further bounces. Surfaces reflect bounced light as diffuse ones of their
/// reflectance. Needs the hits of the rays of all pixels.
void add_bounces(const Simulation& s, const PreparedTof& prepared, const TofExposure& exposure);

}  // namespace glidar
