// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/resolver.hpp>

#include <Eigen/Geometry>

namespace glidar {

/// Range of depths that contains all geometry, metres along the boresight; near > 0. Empty (far <=
/// near) when all of it is behind the sensor.
struct DepthRange {
  double near_m;
  double far_m;

  [[nodiscard]] bool is_empty() const { return !(far_m > near_m); }
};

/// The box around a mesh's vertices, relative to its origin; empty for an empty mesh.
Eigen::AlignedBox3d local_box(const Mesh& mesh);

/// Extends the range by the depths of an instance's box (mesh frame, relative to its origin). The
/// nearest depth may be negative.
void extend_depths(const InstanceView& view, const Eigen::AlignedBox3d& box, double& nearest_m,
                   double& farthest_m);

/// Near and far planes just outside of two depths and in front of the sensor.
DepthRange tight_depth_range(double nearest_m, double farthest_m);

}  // namespace glidar
