// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/radial_velocity.hpp>

#include <glidar/math/constants.hpp>

namespace glidar {
namespace {

/// The velocity of the point of a body at a lever arm from its origin, both in world axes.
Eigen::Vector3d point_velocity_m_s(const KinematicState& body, const Eigen::Vector3d& arm_m) {
  const Eigen::Matrix3d rotation = body.pose.linear();
  const Eigen::Vector3d rate_rad_s = rotation * body.angular_velocity_rad_s;
  return body.velocity_m_s + rate_rad_s.cross(arm_m);
}

}  // namespace

BeamPoint beam_point(const Beams& beams, std::size_t beam, std::int64_t stamp_ns, double range_m) {
  return {.t_ns = stamp_ns + (beams.times_ns.empty() ? 0 : beams.times_ns[beam]),
          .origin_m = beams.origins_m.empty() ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                                              : beams.origins_m[beam],
          .direction = beams.directions[beam],
          .range_m = range_m};
}

double radial_velocity_m_s(const KinematicState& sensor, const KinematicState& object,
                           const BeamPoint& point) {
  const Eigen::Matrix3d world_from_sensor = sensor.pose.linear();
  const Eigen::Vector3d direction = world_from_sensor * point.direction;
  const Eigen::Vector3d origin_arm_m = world_from_sensor * point.origin_m;
  // Positions are subtracted first, for full precision far from the world's origin.
  const Eigen::Vector3d point_arm_m = (sensor.pose.translation() - object.pose.translation()) +
                                      origin_arm_m + point.range_m * direction;
  const Eigen::Vector3d relative_m_s =
      point_velocity_m_s(object, point_arm_m) - point_velocity_m_s(sensor, origin_arm_m);
  return direction.dot(relative_m_s) + 0.0;  // not -0
}

double RadialVelocities::at(const BeamPoint& point, std::uint32_t instance) {
  if (sensor_.t_ns != point.t_ns) {
    sensor_ = {point.t_ns, kInvalidId, state_at(motion_.world_from_sensor, point.t_ns)};
  }
  if (object_.t_ns != point.t_ns || object_.instance != instance) {
    object_ = {point.t_ns, instance,
               instance == kInvalidId
                   ? KinematicState{}
                   : state_at(motion_.world_from_instance[instance], point.t_ns)};
  }
  return radial_velocity_m_s(sensor_.state, object_.state, point);
}

void find_radial_velocities(const Motion& motion, const Beams& beams, std::int64_t stamp_ns,
                            const Hits& hits, BeamRange range, std::span<double> velocities_m_s) {
  RadialVelocities velocities(motion);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const std::uint32_t instance = hits.instance[i];
    velocities_m_s[i] =
        instance == kInvalidId
            ? kNaN
            : velocities.at(beam_point(beams, i, stamp_ns, hits.range_m[i]), instance);
  }
}

void record_radial_velocities(const Motion& motion, const Beams& fired, bool wanted,
                              ThreadPool& thread_pool, Frame& frame) {
  constexpr std::size_t kBeamsPerTask = 1024;
  std::vector<double>& velocities_m_s = frame.true_radial_velocity_m_s;
  velocities_m_s.resize(wanted ? fired.size() : 0);
  if (!wanted) return;
  thread_pool.parallel_for(fired.size(), kBeamsPerTask, [&](std::size_t begin, std::size_t end) {
    find_radial_velocities(motion, fired, frame.stamp_ns, frame.ground_truth, {begin, end},
                           velocities_m_s);
  });
}

}  // namespace glidar
