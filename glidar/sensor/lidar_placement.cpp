// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar_placement.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/portable.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

/// Wider fans are limited to this one: from nearer, little of the scene would be in front of the
/// sensor.
constexpr double kMaxFan_rad = std::numbers::pi / 3.0;
constexpr double kLineHalfAngle_rad = std::numbers::pi / 6.0;  // distance: twice the radius
constexpr double kMinHalfAngle_rad = 1e-3;

struct Elevations {
  double middle_rad = 0.0;
  double half_rad = 0.0;
};

[[noreturn]] void refuse_placing(std::string found, std::string remedy) {
  throw Error({.where = "placing the sensor beside the scene",
               .found = std::move(found),
               .remedy = std::move(remedy)});
}

/// The elevations of the lowest and the highest beam, limited to the horizontal width.
Elevations elevations_of(const Beams& beams) {
  double low_rad = std::numbers::pi;
  double high_rad = -std::numbers::pi;
  double side_rad = 0.0;
  for (const Eigen::Vector3d& d : beams.directions) {
    if (std::isnan(d.x())) continue;
    const double elevation_rad = portable_asin(std::clamp(d.z(), -1.0, 1.0));
    low_rad = std::min(low_rad, elevation_rad);
    high_rad = std::max(high_rad, elevation_rad);
    side_rad = std::max(side_rad, std::abs(portable_atan2(d.y(), d.x())));
  }
  if (low_rad > high_rad) refuse_placing("the sensor has no beams", "");
  const double half_rad = 0.5 * (high_rad - low_rad);
  const double fan_rad = half_rad > kMinHalfAngle_rad ? half_rad : kLineHalfAngle_rad;
  return {0.5 * (low_rad + high_rad),
          std::min({fan_rad, std::max(side_rad, kMinHalfAngle_rad), kMaxFan_rad})};
}

}  // namespace

Pose place_lidar_beside(const Beams& beams, const Scene& scene,
                        const Eigen::Vector3d& from_direction, const Eigen::Vector3d& up) {
  if (beams.size() == 0 || !beams.boresight.isApprox(Eigen::Vector3d::UnitX())) {
    refuse_placing("the sensor is not a LiDAR with boresight +x", "give the sensor's pose");
  }
  const Eigen::AlignedBox3d box = bounds(scene);
  if (box.isEmpty() || !(box.diagonal().norm() > 0.0)) {
    refuse_placing("the scene has no triangles or no extent", "give the sensor's pose");
  }
  const Elevations fan = elevations_of(beams);
  const Eigen::Vector3d z = up.normalized();
  const Eigen::Vector3d side = from_direction - from_direction.dot(z) * z;
  if (!(side.norm() > 1e-9 * from_direction.norm())) {
    refuse_placing("the up vector is parallel to the line of sight", "choose another up vector");
  }
  const double distance_m = 0.5 * box.diagonal().norm() / portable_sin(fan.half_rad);
  const Eigen::Vector3d eye =
      box.center() + distance_m * (portable_cos(fan.middle_rad) * side.normalized() -
                                   portable_sin(fan.middle_rad) * z);
  return look_at(eye, eye - side, z) * optical_from_body();
}

}  // namespace glidar
