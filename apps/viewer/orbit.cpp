// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/orbit.hpp>

#include <glidar/math/portable.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glidar::app {
namespace {

Eigen::Vector3d to_eye(const Orbit& orbit) {
  return {portable_cos(orbit.pitch_rad) * portable_cos(orbit.yaw_rad),
          portable_cos(orbit.pitch_rad) * portable_sin(orbit.yaw_rad),
          portable_sin(orbit.pitch_rad)};
}

double half_height() {
  return portable_tan(kOrbitFov_rad / 2.0);
}

}  // namespace

void turn(Orbit& orbit, const Eigen::Vector2d& drag) {
  constexpr double kSteepest =
      std::numbers::pi / 2.0 - 1e-3;  // the view direction must not be vertical
  orbit.yaw_rad =
      std::remainder(orbit.yaw_rad - std::numbers::pi * drag.x(), 2.0 * std::numbers::pi);
  orbit.pitch_rad =
      std::clamp(orbit.pitch_rad + std::numbers::pi * drag.y(), -kSteepest, kSteepest);
}

void pan(Orbit& orbit, const Eigen::Vector2d& drag) {
  const double height_m = 2.0 * half_height() * orbit.distance_m;
  const Eigen::Matrix3d axes = anchor_from_eye(orbit).linear();
  orbit.pivot_m -= height_m * (drag.x() * axes.col(0) + drag.y() * axes.col(1));
}

void zoom(Orbit& orbit, double steps) {
  constexpr double kNearest_m = 1e-6;
  constexpr double kFarthest_m = 1e9;
  orbit.distance_m =
      std::clamp(orbit.distance_m * portable_pow(0.9, steps), kNearest_m, kFarthest_m);
}

Pose anchor_from_eye(const Orbit& orbit) {
  return look_at(orbit.pivot_m + orbit.distance_m * to_eye(orbit), orbit.pivot_m,
                 Eigen::Vector3d::UnitZ());
}

Eigen::Matrix4f clip_from_anchor(const Orbit& orbit, double aspect) {
  constexpr double kNear = 1e-3;  // of the distance
  constexpr double kFar = 1e3;
  const double near_m = kNear * orbit.distance_m;
  const double far_m = kFar * orbit.distance_m;
  Eigen::Matrix4d clip_from_eye = Eigen::Matrix4d::Zero();
  clip_from_eye(0, 0) = 1.0 / (aspect * half_height());
  clip_from_eye(1, 1) = -1.0 / half_height();
  clip_from_eye(2, 2) = (far_m + near_m) / (far_m - near_m);
  clip_from_eye(2, 3) = -2.0 * far_m * near_m / (far_m - near_m);
  clip_from_eye(3, 2) = 1.0;
  return (clip_from_eye * anchor_from_eye(orbit).inverse().matrix()).cast<float>();
}

std::optional<std::size_t> point_at(const Orbit& orbit, std::span<const Eigen::Vector3f> points,
                                    const Eigen::Vector2d& place, double reach) {
  const Pose eye_from_anchor = anchor_from_eye(orbit).inverse();
  std::optional<std::size_t> best;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d seen = eye_from_anchor * points[i].cast<double>();
    if (!(seen.z() > 0.0 && seen.z() < nearest_m)) continue;
    const Eigen::Vector2d at(seen.x() / seen.z() / half_height(),
                             -seen.y() / seen.z() / half_height());
    if ((at - place).norm() > 2.0 * reach) continue;
    best = i;
    nearest_m = seen.z();
  }
  return best;
}

}  // namespace glidar::app
