// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/core/report.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/motion/timed_poses.hpp>
#include <glidar/motion/torque_free_rotation.hpp>

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

namespace glidar {

class FieldVisitor;

/// Rotation in place at a constant rate: the rates of --object-rate and --sensor-rate, as in the
/// original GLIDAR. The rate is an angular velocity in the body's own axes (right-handed, axis
/// times rad/s), as in the kinematics that the original cites: Markley, "Attitude error
/// representations for Kalman filtering", J. Guidance, Control, and Dynamics 26(2) (2003),
/// equation 10. Because the rate is constant, the axis is fixed in the world too.
struct Spin {
  Pose pose = Pose::Identity();  ///< at t0_ns; the position is constant
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
  std::int64_t t0_ns = 0;
};

Pose pose_at(const Spin& spin, std::int64_t t_ns);

/// Keys of `spin`; files have the pose beside it, at time 0.
void describe(Spin& spin, FieldVisitor& visitor);

/// The coordinate frame of a twist.
enum class TwistFrame : std::uint8_t {
  body,   ///< the moving body: linear is the velocity of its origin, in its own axes
  world,  ///< the world ("spatial twist"): linear is the velocity of the point of the body,
          ///< extended if necessary, at the world's origin
};

/// A constant screw motion: pose exp(twist s) for a twist in the body frame, exp(twist s) pose for
/// one in the world frame, s seconds after t0 (Lynch and Park, "Modern Robotics" (2017), section
/// 3.3.2).
struct ConstantTwist {
  Pose pose = Pose::Identity();  ///< at t0_ns
  Eigen::Vector3d angular_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d linear_m_s = Eigen::Vector3d::Zero();
  TwistFrame frame = TwistFrame::body;
  std::int64_t t0_ns = 0;
};

Pose pose_at(const ConstantTwist& twist, std::int64_t t_ns);

/// Keys of `twist`; files have the pose beside it, at time 0.
void describe(ConstantTwist& twist, FieldVisitor& visitor);

/// A part fixed to a body whose motion has a closed form for one of its points only.
struct Mounted {
  std::variant<TimedPoses, TorqueFreeRotation> carrier;
  Pose carrier_from_body = Pose::Identity();
};

Pose pose_at(const Mounted& mounted, std::int64_t t_ns);

/// A stationary body.
struct ConstantPose {
  Pose pose = Pose::Identity();
};

/// A pose as a function of time.
using Trajectory =
    std::variant<ConstantPose, ConstantTwist, Spin, TimedPoses, TorqueFreeRotation, Mounted>;

/// The pose at a time. A pure function: the same time always gives the same bits.
Pose pose_at(const Trajectory& trajectory, std::int64_t t_ns);

/// The poses at many times, identical to pose_at() for each; fastest if the times increase.
/// Throws Error if `t_ns` and `out` differ in size.
void poses_at(const Trajectory& trajectory, std::span<const std::int64_t> t_ns,
              std::span<Pose> out);

/// Throws Error with the invalid field unless every number is finite and poses are rigid.
void validate(const Trajectory& trajectory);

/// The closed interval [first, last].
struct TimeInterval {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::min();
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::max();
};

/// The times for which the trajectory is defined: all times, except for timed poses.
TimeInterval valid_interval(const Trajectory& trajectory);

/// Warns if some of the requested times are outside the valid interval, where the first or last
/// pose is used.
void warn_extrapolation(const Trajectory& trajectory, std::string_view name,
                        const TimeInterval& requested, const Report& report);

/// Warns if the trajectory interpolates timed poses linearly, which suits no inertial sensor.
void warn_linear_interpolation(const Trajectory& trajectory, std::string_view name,
                               const Report& report);

/// The poses of the sensor and of all instances as functions of time.
struct Motion {
  Trajectory world_from_sensor;
  std::vector<Trajectory> world_from_instance;  ///< one per instance of the scene
};

/// The sensor at this pose, and every instance at its pose in the scene.
Motion static_motion(const Scene& scene, const Pose& world_from_sensor);

/// The sensor and the scene's instances on these trajectories; without trajectories of instances,
/// all of them are stationary. Throws Error unless there are none or one per instance.
Motion make_motion(const Scene& scene, const Trajectory& world_from_sensor,
                   const std::vector<Trajectory>& world_from_instance);

/// The trajectory in another world frame: moved_from_world * pose_at(trajectory, t).
Trajectory transformed(const Pose& moved_from_world, const Trajectory& trajectory);

/// The trajectory at other times: its pose at `to_ns` is that at `from_ns`, bit for bit. Throws
/// Error if a time leaves the range of nanoseconds.
Trajectory retimed(const Trajectory& trajectory, std::int64_t from_ns, std::int64_t to_ns);

/// The trajectory of a part that is fixed to a body: pose_at(world_from_body, t) * body_from_part.
Trajectory compose_extrinsic(const Trajectory& world_from_body, const Pose& body_from_part);

/// Writes the poses of the sensor and all instances at frame.stamp_ns to the frame.
void sample_poses(const Motion& motion, Frame& frame);

}  // namespace glidar
