// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/motion.

#include <glidar/motion/kinematics.hpp>
#include <glidar/motion/timed_poses.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace glidar {

/// A twice continuously differentiable motion through timed poses. Positions are the natural cubic
/// spline (de Boor, "A Practical Guide to Splines" (1978), chapter IV). Orientations between two
/// entries are R Exp(r(t)) with a cubic r(t), whose coefficients make the body's angular velocity
/// and acceleration continuous (Mayorov, "Smooth attitude interpolation" (2018), the method of
/// scipy.spatial.transform.RotationSpline). At both ends the accelerations are 0. Two poses give
/// constant velocities, identical to linear interpolation except for rounding.
class PoseSpline {
 public:
  /// Throws Error if the rotations between poses are so large that there is no such curve.
  explicit PoseSpline(std::span<const TimedPose> poses);

  /// The pose `since_s` after the entry `before`, which is not the last; poses are those of the
  /// constructor.
  [[nodiscard]] Pose pose_at(std::span<const TimedPose> poses, std::size_t before,
                             double since_s) const;

  /// The same with derivatives.
  [[nodiscard]] KinematicState state_at(std::span<const TimedPose> poses, std::size_t before,
                                        double since_s) const;

  /// Upper bounds of the rates between the entry `before`, which is not the last, and the next.
  [[nodiscard]] MaxRates max_rates(std::span<const TimedPose> poses, std::size_t before) const;

 private:
  std::vector<Eigen::Vector3d> velocity_m_s_;  ///< at each entry, world axes
  std::vector<Eigen::Vector3d> rate_rad_s_;    ///< at each entry, body axes
};

}  // namespace glidar
