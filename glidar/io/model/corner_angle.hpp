// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/math/elementary.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <numbers>

namespace glidar {

/// The angle between two vectors of any length, in radians from 0 to pi; 0 unless both are finite
/// and not zero. It has the same bits with every C library, unlike std::atan2 for floats.
inline float angle_between_rad(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const double turns = atan2_turns(a.cross(b).norm(), a.dot(b));
  return static_cast<float>(2.0 * std::numbers::pi * turns);
}

}  // namespace glidar
