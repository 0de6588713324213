// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/resolver.hpp>

#include <Eigen/Geometry>

namespace glidar {

/// The depths between which geometry lies, metres along the boresight; near > 0. Empty (far <=
/// near) when all of it lies behind the sensor.
struct DepthRange {
  double near_m;
  double far_m;

  [[nodiscard]] bool is_empty() const { return !(far_m > near_m); }
};

/// The box around a mesh's vertices, relative to its origin; empty for an empty mesh.
Eigen::AlignedBox3d local_box(const Mesh& mesh);

/// Depths of a box of an instance (mesh's frame, relative to its origin), from the sensor's plane.
/// The nearest may be negative.
void extend_depths(const InstanceView& view, const Eigen::AlignedBox3d& box, double& nearest_m,
                   double& farthest_m);

/// The planes that hug what lies between two depths: a hair outside of them, and in front of the
/// sensor.
DepthRange tight_depth_range(double nearest_m, double farthest_m);

}  // namespace glidar
