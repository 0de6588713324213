// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/report.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/motion/constant_twist.hpp>
#include <glidar/motion/mounted.hpp>
#include <glidar/motion/spin.hpp>
#include <glidar/motion/timed_poses.hpp>
#include <glidar/motion/torque_free_rotation.hpp>

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

namespace glidar {

/// Standing still.
struct ConstantPose {
  Pose pose = Pose::Identity();
};

/// A pose as a function of time.
using Trajectory =
    std::variant<ConstantPose, ConstantTwist, Spin, TimedPoses, TorqueFreeRotation, Mounted>;

/// A pure function: the same time gives the same bits, in any order of asking.
Pose pose_at(const Trajectory& trajectory, std::int64_t t_ns);

/// The poses at many times, the same as one by one; quickest when the times increase.
/// Throws Error when the two are not of one size.
void poses_at(const Trajectory& trajectory, std::span<const std::int64_t> t_ns,
              std::span<Pose> out);

/// Throws Error, naming the field, unless every number is finite and poses are rigid.
void validate(const Trajectory& trajectory);

/// From the first to the last time, both included.
struct TimeInterval {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::min();
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::max();
};

/// The times for which the trajectory is known; all, except for timed poses.
TimeInterval valid_interval(const Trajectory& trajectory);

/// Warns when some of the times asked for lie outside those known, where the end pose holds.
void warn_extrapolation(const Trajectory& trajectory, std::string_view name,
                        const TimeInterval& asked, const Report& report);

/// Where everything is at any time.
struct Motion {
  Trajectory world_from_sensor;
  std::vector<Trajectory> world_from_instance;  ///< one per instance of the scene
};

/// The sensor at this pose, every instance where the scene puts it.
Motion static_motion(const Scene& scene, const Pose& world_from_sensor);

/// The scene's instances on these trajectories, the sensor on its own; none: every instance stands
/// still. Throws Error unless there are none or one per instance.
Motion make_motion(const Scene& scene, const Trajectory& world_from_sensor,
                   const std::vector<Trajectory>& world_from_instance);

/// The same motion after all of it was moved: moved_from_world * pose_at(trajectory, t).
Trajectory transformed(const Pose& moved_from_world, const Trajectory& trajectory);

/// The motion of what is fixed to a body: pose_at(world_from_body, t) * body_from_part.
Trajectory compose_extrinsic(const Trajectory& world_from_body, const Pose& body_from_part);

/// Writes the poses of all at frame.stamp_ns into the frame.
void sample_poses(const Motion& motion, Frame& frame);

}  // namespace glidar
