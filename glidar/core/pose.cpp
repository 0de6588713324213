// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/pose.hpp>

#include <glidar/core/error.hpp>

#include <cmath>

namespace glidar {

bool is_within_reach(const Eigen::Vector3d& position_m) {
  return position_m.cwiseAbs().maxCoeff() <= kMaxCoordinate_m && position_m.allFinite();
}

Pose look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, const Eigen::Vector3d& up) {
  if (!is_within_reach(eye) || !is_within_reach(target) || !up.allFinite()) {
    throw Error({.where = "look_at",
                 .found = "a number is not finite or too large",
                 .allowed = "coordinates up to 1e15 m"});
  }
  const Eigen::Vector3d forward = target - eye;
  const Eigen::Vector3d right = forward.cross(up);
  if (!(forward.norm() > 0.0)) {
    throw Error({.where = "look_at",
                 .found = "eye and target are the same point",
                 .allowed = "two distinct points"});
  }
  constexpr double kMinSine = 1e-9;  // below it the roll angle is not defined
  if (!(right.norm() > kMinSine * forward.norm() * up.norm())) {
    throw Error({.where = "look_at",
                 .found = "the up vector is parallel to the line of sight",
                 .allowed = "an up vector in another direction",
                 .remedy = "choose another up vector"});
  }
  Pose world_from_camera = Pose::Identity();
  const Eigen::Vector3d z = forward.normalized();
  const Eigen::Vector3d x = right.normalized();
  world_from_camera.linear() << x, z.cross(x), z;
  world_from_camera.translation() = eye;
  return world_from_camera;
}

Pose look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  const Eigen::Vector3d forward = (target - eye).stableNormalized();
  const bool is_vertical = forward.head<2>().norm() <= kVerticalSine;
  return look_at(eye, target, is_vertical ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ());
}

Pose optical_from_body() {
  Pose pose = Pose::Identity();
  pose.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return pose;
}

Pose woods2016_from_optical() {
  Pose pose = Pose::Identity();
  pose.linear().diagonal() = Eigen::Vector3d(-1.0, -1.0, 1.0);
  return pose;
}

Pose make_pose(const Eigen::Vector3d& position_m, const Eigen::Quaterniond& orientation) {
  if (!is_within_reach(position_m) || !orientation.coeffs().allFinite() ||
      orientation.coeffs().isZero(0.0)) {
    throw Error({.where = "pose",
                 .found = "a number is not finite or too large, or the quaternion is zero",
                 .allowed = "up to 1e15 m, and a quaternion of any length except zero"});
  }
  // Squares of larger numbers overflow, and those of smaller ones underflow.
  constexpr double kSquareSafe = 1e100;
  Eigen::Quaterniond scaled = orientation;
  const double largest = scaled.coeffs().cwiseAbs().maxCoeff();
  if (largest > kSquareSafe || largest < 1.0 / kSquareSafe) scaled.coeffs() /= largest;
  Pose pose = Pose::Identity();
  pose.linear() = scaled.normalized().toRotationMatrix();
  pose.translation() = position_m;
  return pose;
}

Pose se3_exp(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& translation_m) {
  const double angle = rotation_rad.stableNorm();
  Pose pose = Pose::Identity();
  pose.translation() = translation_m;
  if (angle == 0.0) return pose;
  pose.linear() = axis_angle(rotation_rad / angle, angle).toRotationMatrix();
  // Coefficients for axis times angle: a = (1 - cos) / angle^2, b = (angle - sin) / angle^3,
  // without cancellation.
  constexpr double kSmall = 0.1;  // up to it the first omitted term is at most 3e-16
  const double x = angle * angle;
  const double half = portable_sin(0.5 * angle) / angle;
  const double b = angle < kSmall ? 1.0 / 6.0 - x / 120.0 + x * x / 5040.0 - x * x * x / 362880.0
                                  : (angle - portable_sin(angle)) / (angle * x);
  const Eigen::Vector3d once = rotation_rad.cross(translation_m);
  pose.translation() += 2.0 * half * half * once + b * rotation_rad.cross(once);
  return pose;
}

PoseVector to_xyz_wxyz(const Pose& pose) {
  Eigen::Quaterniond q(pose.linear());
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  PoseVector numbers;
  numbers << pose.translation(), q.w(), q.vec();
  return numbers;
}

bool is_rigid(const Pose& pose, double tolerance) {
  if (!pose.matrix().allFinite()) return false;
  const Eigen::Matrix3d r = pose.linear();
  const double deviation = (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return deviation <= tolerance && r.determinant() > 0.0;
}

}  // namespace glidar
