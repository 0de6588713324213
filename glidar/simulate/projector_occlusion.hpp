// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/simulation.hpp>

namespace glidar {

/// A ray from a light that hits a surface before this share of its way to a point shows that the
/// point is in shadow. Relative: far above rounding, far below any shadow.
inline constexpr double kShadowEpsilon = 1e-6;

/// Entries of a frame of which something is determined.
using EntryFilter = FunctionRef<bool(std::size_t entry)>;

/// Sets hidden[i] to 1 where a point in the sensor frame does not see the surface that beam i hits,
/// and to 0 elsewhere and for entries that the filter does not accept. Every such hit is cast at
/// once more from the point, at its beam's firing time. Needs normal in frame.ground_truth.
void find_hidden(const Simulation& s, const Eigen::Vector3d& origin_m, EntryFilter is_tested,
                 std::vector<std::uint8_t>& hidden);

/// Removes the returns of surfaces that the sensor's projector does not see: they become occluded.
/// Between a front surface at depth z1 and one behind it at z2 the shadow is f b (1/z1 - 1/z2)
/// pixels wide, with b the distance between projector and camera. Needs normal in
/// frame.ground_truth.
void occlude_from_projector(const Simulation& s, const Eigen::Vector3d& projector_origin_m);

}  // namespace glidar
