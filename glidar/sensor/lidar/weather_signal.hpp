// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/lidar/lidar_equation.hpp>

namespace glidar {

// Fog and drops close to the sensor: signals grow as 1/R^2 down to the range where the beam no
// longer overlaps the receiver's field of view.

/// The range below which the receiver sees nothing: where the overlap table becomes positive, or
/// 0.9 m without such a table.
double min_visible_range_m(const LidarEquation& light);

/// Overlap near the sensor if the overlap table does not define it: linear from 0 at 0.9 m to 1 at
/// 1.0 m (Hahner et al., "Fog simulation on real LiDAR point clouds in adverse weather", ICCV
/// 2021). 1 if the table defines it, i.e. begins with 0 at a positive range.
double crossover(const LidarEquation& light, double range_m);

/// S of backscatter from the air: received_signal() times the crossover.
double weather_signal(const LidarEquation& light, double backscatter, double range_m);

}  // namespace glidar
