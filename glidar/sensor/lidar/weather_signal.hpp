// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/lidar/lidar_equation.hpp>

namespace glidar {

// Fog and drops close to the sensor: their signals grow as 1/R^2 up to where lamp and receiver no
// longer see the same air.

/// Nothing nearer is seen: where the light's overlap table leaves 0, or 0.9 m without such a table.
double nearest_in_view_m(const LidarEquation& light);

/// What the overlap table leaves open: from 0 at 0.9 m to 1 at 1.0 m in a line (Hahner et al., "Fog
/// simulation on real LiDAR point clouds in adverse weather", ICCV 2021); 1 when it does tell the
/// near end, by beginning with 0 beyond the lens.
double crossover(const LidarEquation& light, double range_m);

/// S of what sends light back from the air: received_signal times the crossover.
double air_signal(const LidarEquation& light, double backscatter, double range_m);

}  // namespace glidar
