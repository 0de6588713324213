// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/tof_light.hpp>

namespace glidar {

/// Adds the light over bounces of an exposure to the pixels, averaged over those pixels of a square
/// of bounce_filter_px around each that see the same surface: of similar normals, and near each
/// other's plane. Light on a surface changes slowly, so this reduces the noise of the paths; the
/// sum over these pixels is divided by the sum of their reflectances and multiplied by that of the
/// pixel. Needs range_m and normal in frame.ground_truth.
void add_filtered_bounces(const Simulation& s, const PreparedTof& prepared,
                          const TofExposure& exposure);

}  // namespace glidar
