// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/kinematics.hpp>

#include <glidar/motion/rotation_vector.hpp>
#include <glidar/motion/times.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

KinematicState state_of(const ConstantPose& constant, std::int64_t /*t_ns*/) {
  return {.pose = constant.pose};
}

/// The velocity of the origin is R v for a twist in the body frame and v + w x p for one in the
/// world frame (Lynch and Park, "Modern Robotics" (2017), section 3.3.2). Its derivative follows
/// from R' = R [w] and p' = v + w x p.
KinematicState state_of(const ConstantTwist& twist, std::int64_t t_ns) {
  KinematicState state{.pose = pose_at(twist, t_ns)};
  const Eigen::Vector3d& w = twist.angular_rad_s;
  if (twist.frame == TwistFrame::body) {
    state.velocity_m_s = state.pose.linear() * twist.linear_m_s;
    state.acceleration_m_s2 = state.pose.linear() * w.cross(twist.linear_m_s);
    state.angular_velocity_rad_s = w;
  } else {
    state.velocity_m_s = twist.linear_m_s + w.cross(state.pose.translation());
    state.acceleration_m_s2 = w.cross(state.velocity_m_s);
    state.angular_velocity_rad_s = twist.pose.linear().transpose() * w;  // the same at all times
  }
  return state;
}

KinematicState state_of(const Spin& spin, std::int64_t t_ns) {
  return {.pose = pose_at(spin, t_ns), .angular_velocity_rad_s = spin.rate_rad_s};
}

KinematicState state_of(const TimedPoses& poses, std::int64_t t_ns) {
  return poses.state_at(t_ns);
}

/// The centre of mass moves at a constant velocity; the rest is its lever arm to the body's origin.
KinematicState state_of(const TorqueFreeRotation& tumbling, std::int64_t t_ns) {
  const InitialRotation& start = tumbling.start();
  const Pose pose = tumbling.pose_at(t_ns);
  const KinematicState principal{
      .pose = pose * start.body_from_principal,
      .velocity_m_s = start.velocity_m_s,
      .angular_velocity_rad_s = tumbling.rate_at(t_ns),
      .angular_acceleration_rad_s2 = tumbling.angular_acceleration_at(t_ns)};
  KinematicState state = compose_extrinsic(principal, start.body_from_principal.inverse());
  state.pose = pose;
  return state;
}

KinematicState state_of(const Mounted& mounted, std::int64_t t_ns) {
  const auto carrier = [t_ns](const auto& kind) { return state_of(kind, t_ns); };
  return compose_extrinsic(std::visit(carrier, mounted.carrier), mounted.carrier_from_body);
}

/// Bounds of a point's motion: a drift, and a rotation with an arm.
struct PointRates {
  double drift_m_s = 0.0;
  double angular_rad_s = 0.0;
  double arm_m = 0.0;
};

PointRates rates_of(const ConstantPose& /*constant*/, const Eigen::Vector3d& /*point_m*/,
                    const TimeInterval& /*interval*/) {
  return {};
}

/// On a screw motion every point of the body has a constant speed.
PointRates rates_of(const ConstantTwist& twist, const Eigen::Vector3d& point_m,
                    const TimeInterval& /*interval*/) {
  const Eigen::Vector3d place_m =
      twist.frame == TwistFrame::body ? point_m : Eigen::Vector3d(twist.pose * point_m);
  return {.drift_m_s = (twist.linear_m_s + twist.angular_rad_s.cross(place_m)).norm()};
}

PointRates rates_of(const Spin& spin, const Eigen::Vector3d& point_m,
                    const TimeInterval& /*interval*/) {
  return {.angular_rad_s = spin.rate_rad_s.norm(), .arm_m = point_m.norm()};
}

PointRates rates_of(const TimedPoses& poses, const Eigen::Vector3d& point_m,
                    const TimeInterval& interval) {
  const MaxRates rates = poses.max_rates(interval);
  return {rates.linear_m_s, rates.angular_rad_s, point_m.norm()};
}

/// The energy bounds the rate: 2 E = I_x w_x^2 + I_y w_y^2 + I_z w_z^2 >= I_min |w|^2.
PointRates rates_of(const TorqueFreeRotation& tumbling, const Eigen::Vector3d& point_m,
                    const TimeInterval& /*interval*/) {
  const InitialRotation& start = tumbling.start();
  const Eigen::Vector3d ratios = start.moments_kg_m2 / start.moments_kg_m2.minCoeff();
  return {.drift_m_s = start.velocity_m_s.norm(),
          .angular_rad_s = std::sqrt(ratios.dot(start.rate_rad_s.cwiseAbs2())),
          .arm_m = (point_m - start.body_from_principal.translation()).norm()};
}

PointRates rates_of(const Mounted& mounted, const Eigen::Vector3d& point_m,
                    const TimeInterval& interval) {
  const Eigen::Vector3d on_carrier_m = mounted.carrier_from_body * point_m;
  const auto carrier = [&](const auto& kind) { return rates_of(kind, on_carrier_m, interval); };
  return std::visit(carrier, mounted.carrier);
}

}  // namespace

double max_displacement_m(const Trajectory& trajectory, const Eigen::Vector3d& point_m,
                          std::int64_t t_ns, const TimeInterval& interval) {
  constexpr double kRounding = 1.0 + 0x1p-40;
  constexpr double kClockStep_s = 4e-6;  // seconds_between() rounds times far from their origin
  const PointRates rates =
      std::visit([&](const auto& kind) { return rates_of(kind, point_m, interval); }, trajectory);
  const double before_s = seconds_between(interval.first_ns, t_ns);
  const double after_s = seconds_between(t_ns, interval.last_ns);
  const double duration_s = kClockStep_s + std::max(before_s, after_s);
  const double chord = std::min(rates.angular_rad_s * duration_s, 2.0);
  return kRounding * (rates.drift_m_s * duration_s + chord * rates.arm_m);
}

KinematicState state_at(const Trajectory& trajectory, std::int64_t t_ns) {
  return std::visit([t_ns](const auto& kind) { return state_of(kind, t_ns); }, trajectory);
}

KinematicState compose_extrinsic(const KinematicState& body, const Pose& body_from_part) {
  const Eigen::Vector3d arm_m = body_from_part.translation();
  const Eigen::Vector3d& w = body.angular_velocity_rad_s;
  const Eigen::Vector3d& a = body.angular_acceleration_rad_s2;
  const Eigen::Matrix3d part_from_body = body_from_part.linear().transpose();
  const Eigen::Vector3d velocity_m_s = w.cross(arm_m);
  KinematicState part{.pose = body.pose * body_from_part};
  part.velocity_m_s = body.velocity_m_s + body.pose.linear() * velocity_m_s;
  part.acceleration_m_s2 =
      body.acceleration_m_s2 + body.pose.linear() * (a.cross(arm_m) + w.cross(velocity_m_s));
  part.angular_velocity_rad_s = part_from_body * w;
  part.angular_acceleration_rad_s2 = part_from_body * a;
  return part;
}

KinematicState linear_state(std::span<const TimedPose> poses, std::size_t before) {
  const TimedPose& from = poses[before];
  const TimedPose& to = poses[before + 1];
  const double duration_s = seconds_between(from.t_ns, to.t_ns);
  KinematicState state;
  state.velocity_m_s = (to.position_m - from.position_m) / duration_s;
  state.angular_velocity_rad_s = rotation_between(from.orientation, to.orientation) / duration_s;
  return state;
}

}  // namespace glidar
