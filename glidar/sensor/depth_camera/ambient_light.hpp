// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace glidar {

class FieldVisitor;

/// Light other than the projector's, within the passband of the camera.
struct AmbientLight {
  double ambient_w_per_m2 = 0.03;  ///< irradiance of every surface, from all sides
  double sun_w_per_m2 = 0.0;       ///< irradiance of a surface that faces the sun
  /// Towards the sun in the world frame, of any length.
  Eigen::Vector3d sun_direction = Eigen::Vector3d::UnitZ();
};

/// Keys of `illumination` of depth cameras.
void describe(AmbientLight& light, FieldVisitor& visitor);

}  // namespace glidar
