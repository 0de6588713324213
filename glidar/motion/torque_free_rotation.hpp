// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>

#include <cstdint>
#include <memory>

namespace glidar {

/// A rigid body on which no torque acts, at t0.
struct InitialRotation {
  Eigen::Vector3d moments_kg_m2 = Eigen::Vector3d::Ones();  ///< principal; only ratios matter
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();     ///< about the principal axes
  Pose world_from_body = Pose::Identity();
  Pose body_from_principal = Pose::Identity();  ///< centre of mass and principal axes in the body
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();  ///< of the centre of mass, in the world
  std::int64_t t0_ns = 0;
};

/// The free motion of that body in closed form, by Jacobi's elliptic functions: Landau & Lifshitz,
/// "Mechanics" (3rd ed.), section 37, with an attitude that is regular near every axis. Any time
/// costs the same, nothing is integrated step by step. The attitude is exact to 1e-13 rad and 1e-15
/// of the angle turned, angular momentum and energy to 1e-13 of themselves, in all directions and
/// at all rates; bytes are the same on any machine. Off-axis rates below 1e-140 of the whole count
/// as none. A start exactly on the separatrix (the one that takes forever to turn over) turns over
/// after some 343 of the elliptic functions' units of time.
class TorqueFreeRotation {
 public:
  /// Throws Error naming the field when a number is not finite, a moment is not above 0 or 1e9
  /// times another, one is larger than the two others together (no body has such), or the pose is
  /// not rigid.
  explicit TorqueFreeRotation(const InitialRotation& start);

  [[nodiscard]] Pose pose_at(std::int64_t t_ns) const;

  /// The angular velocity along the principal axes.
  [[nodiscard]] Eigen::Vector3d rate_at(std::int64_t t_ns) const;

  [[nodiscard]] const InitialRotation& start() const { return start_; }

 private:
  struct Solution;

  InitialRotation start_;
  std::shared_ptr<const Solution> solution_;  ///< empty: the rate is constant
};

}  // namespace glidar
