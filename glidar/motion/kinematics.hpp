// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/motion/motion.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace glidar {

/// The pose of a body and its derivatives by time.
struct KinematicState {
  Pose pose = Pose::Identity();                            ///< world_from_body
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();  ///< of the body's origin, world axes
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();       ///< of the same, world axes
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();  ///< body axes
  Eigen::Vector3d angular_acceleration_rad_s2 = Eigen::Vector3d::Zero();  ///< body axes
};

/// The state at a time, in closed form. The pose is that of pose_at(), bit for bit. The derivatives
/// of timed poses are those of their interpolation, see TimedPoses::state_at().
KinematicState state_at(const Trajectory& trajectory, std::int64_t t_ns);

/// The state of a part that is fixed to a body with this state. The lever arm r adds w x r to the
/// velocity, and the tangential a x r and the centripetal w x (w x r) to the acceleration
/// (Siciliano et al., "Robotics: Modelling, Planning and Control" (2009), section 7.2.2).
KinematicState compose_extrinsic(const KinematicState& body, const Pose& body_from_part);

/// Bounds of a body's motion during an interval.
struct MaxRates {
  double linear_m_s = 0.0;     ///< of the body's origin
  double angular_rad_s = 0.0;  ///< about any axis
};

/// An upper bound of the distance between the places of a body's point at `t_ns` and at any time of
/// the interval, metres. `point_m`: in the body's frame. Less than twice the distance where rates
/// are constant.
double max_displacement_m(const Trajectory& trajectory, const Eigen::Vector3d& point_m,
                          std::int64_t t_ns, const TimeInterval& interval);

/// The state between the entries `before` and `before` + 1 of linearly interpolated poses, except
/// its pose.
KinematicState linear_state(std::span<const TimedPose> poses, std::size_t before);

}  // namespace glidar
