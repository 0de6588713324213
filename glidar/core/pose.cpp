// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/pose.hpp>

#include <glidar/core/error.hpp>

namespace glidar {

Pose look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, const Eigen::Vector3d& up) {
  const Eigen::Vector3d forward = target - eye;
  const Eigen::Vector3d right = forward.cross(up);
  if (!(forward.norm() > 0.0)) {
    throw Error({.where = "look_at",
                 .found = "eye and target are the same point",
                 .allowed = "two distinct points",
                 .remedy = ""});
  }
  constexpr double kSmallestSine = 1e-9;  // below it the roll angle is not defined
  if (!(right.norm() > kSmallestSine * forward.norm() * up.norm())) {
    throw Error({.where = "look_at",
                 .found = "the up vector is parallel to the line of sight",
                 .allowed = "an up vector that is not",
                 .remedy = "choose another up vector"});
  }
  Pose world_from_camera = Pose::Identity();
  const Eigen::Vector3d z = forward.normalized();
  const Eigen::Vector3d x = right.normalized();
  world_from_camera.linear() << x, z.cross(x), z;
  world_from_camera.translation() = eye;
  return world_from_camera;
}

Pose make_pose(const Eigen::Vector3d& position_m, const Eigen::Quaterniond& orientation) {
  const double norm = orientation.norm();
  if (!position_m.allFinite() || !orientation.coeffs().allFinite() || !(norm > 0.0)) {
    throw Error({.where = "pose",
                 .found = "a number is not finite or the quaternion is zero",
                 .allowed = "finite metres and a quaternion of any length but zero",
                 .remedy = ""});
  }
  Pose pose = Pose::Identity();
  pose.linear() = orientation.normalized().toRotationMatrix();
  pose.translation() = position_m;
  return pose;
}

bool is_rigid(const Pose& pose, double tolerance) {
  if (!pose.matrix().allFinite()) return false;
  const Eigen::Matrix3d r = pose.linear();
  const double deviation = (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return deviation <= tolerance && r.determinant() > 0.0;
}

}  // namespace glidar
