// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/verify/special_cases.hpp>

#include <vector>

namespace glidar {

/// What the library computes apart from casts: rays through lenses, colours and reflectances of
/// surfaces, signals by the lidar equation, echoes of beams with a footprint, and poses and radial
/// velocities of a moving sensor. The shapes must outlive the cases.
void add_measurement_cases(const std::vector<Shape>& shapes, std::vector<SpecialCase>& cases);

}  // namespace glidar
