// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>

#include <cstdint>
#include <memory>

namespace glidar {

class FieldVisitor;

/// The state at t0 of a rigid body without torque.
struct InitialRotation {
  Eigen::Vector3d moments_kg_m2 =
      Eigen::Vector3d::Ones();  ///< principal moments of inertia; only ratios matter
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();  ///< about the principal axes
  Pose world_from_body = Pose::Identity();
  Pose body_from_principal = Pose::Identity();  ///< centre of mass and principal axes in the body
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();  ///< of the centre of mass, in the world
  std::int64_t t0_ns = 0;
};

/// Throws Error with the invalid field if a number is not finite, a moment of inertia is not
/// positive or is more than 1e9 times another, one exceeds the sum of the other two (impossible
/// for a body), or a pose is not rigid.
void validate(const InitialRotation& start);

/// Keys of `tumbling`; files have the pose of the body beside it, at time 0.
void describe(InitialRotation& start, FieldVisitor& visitor);

/// The free motion of a rigid body in closed form, by Jacobi's elliptic functions: Landau and
/// Lifshitz, "Mechanics" (3rd ed.), section 37, with an attitude that is regular near every axis.
/// Every time has the same cost; nothing is integrated stepwise. The attitude is exact to 1e-13 rad
/// and 1e-15 of the rotation angle, angular momentum and energy to a relative 1e-13, for all axes
/// and rates; results are bit-identical on any machine. Off-axis rates below 1e-140 of the total
/// are ignored. A start exactly on the separatrix, which theoretically never flips, flips after
/// about 343 of the elliptic functions' units of time.
class TorqueFreeRotation {
 public:
  /// Throws Error as validate() does.
  explicit TorqueFreeRotation(const InitialRotation& start);

  [[nodiscard]] Pose pose_at(std::int64_t t_ns) const;

  /// The angular velocity in the principal axes, rad/s.
  [[nodiscard]] Eigen::Vector3d rate_at(std::int64_t t_ns) const;

  /// The angular acceleration in the principal axes, rad/s^2: Euler's equations without torque
  /// (Landau and Lifshitz, equation 36.5).
  [[nodiscard]] Eigen::Vector3d angular_acceleration_at(std::int64_t t_ns) const;

  [[nodiscard]] const InitialRotation& start() const { return start_; }

 private:
  struct Solution;

  InitialRotation start_;
  std::shared_ptr<const Solution> solution_;  ///< nullptr: the rate is constant
};

}  // namespace glidar
