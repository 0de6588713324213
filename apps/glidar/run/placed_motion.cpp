// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/placed_motion.hpp>

#include <glidar/core/pose.hpp>

#include <algorithm>
#include <variant>

namespace glidar::app {
namespace {

/// A free body with a constant angular rate, as with equal moments of inertia.
Trajectory trajectory_of(const lockstep::Body& body, std::int64_t t_ns) {
  if (body.rate_rad_s.isZero(0.0) && body.velocity_m_s.isZero(0.0)) {
    return ConstantPose{body.world_from_body};
  }
  return TorqueFreeRotation(
      {.rate_rad_s = body.world_from_body.linear().transpose() * body.rate_rad_s,
       .world_from_body = body.world_from_body,
       .velocity_m_s = body.velocity_m_s,
       .t0_ns = t_ns});
}

lockstep::Body body_of(const Trajectory& still) {
  return {.world_from_body = std::get<ConstantPose>(still).pose};
}

bool is_trajectory_within_reach(const Trajectory& trajectory) {
  const auto* still = std::get_if<ConstantPose>(&trajectory);
  return still == nullptr || glidar::is_within_reach(still->pose.translation());
}

}  // namespace

RigMotion motion_at(const lockstep::Moment& moment, const PreparedScene& prepared) {
  RigMotion motion = {.world_from_rig = trajectory_of(moment.sensor, moment.t_ns),
                      .world_from_instance = {}};
  for (const lockstep::Body& object : moment.objects) {
    motion.world_from_instance.push_back(trajectory_of(object, moment.t_ns));
  }
  if (moment.objects.empty()) motion.world_from_instance = prepared.motion.world_from_instance;
  return motion;
}

lockstep::Moment static_moment(const RigMotion& motion) {
  lockstep::Moment moment;
  moment.sensor = body_of(motion.world_from_rig);
  const auto is_constant = [](const Trajectory& instance) {
    return std::holds_alternative<ConstantPose>(instance);
  };
  if (!std::ranges::all_of(motion.world_from_instance, is_constant)) return moment;
  for (const Trajectory& instance : motion.world_from_instance) {
    moment.objects.push_back(body_of(instance));
  }
  return moment;
}

bool is_within_reach(const Motion& motion) {
  return is_trajectory_within_reach(motion.world_from_sensor) &&
         std::ranges::all_of(motion.world_from_instance, is_trajectory_within_reach);
}

}  // namespace glidar::app
