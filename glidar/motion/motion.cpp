// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/motion.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/time_text.hpp>
#include <glidar/motion/rate_keys.hpp>
#include <glidar/motion/times.hpp>

#include <string>
#include <type_traits>
#include <utility>

namespace glidar {

Pose pose_at(const Spin& spin, std::int64_t t_ns) {
  const double s = seconds_between(spin.t0_ns, t_ns);
  return spin.pose * se3_exp(spin.rate_rad_s * s, Eigen::Vector3d::Zero());
}

void describe(Spin& spin, FieldVisitor& visitor) {
  visit_rate(visitor, true, spin.rate_rad_s);
}

Pose pose_at(const ConstantTwist& twist, std::int64_t t_ns) {
  const double s = seconds_between(twist.t0_ns, t_ns);
  const Pose moved = se3_exp(twist.angular_rad_s * s, twist.linear_m_s * s);
  return twist.frame == TwistFrame::body ? twist.pose * moved : moved * twist.pose;
}

void describe(ConstantTwist& twist, FieldVisitor& visitor) {
  constexpr std::array<Named<TwistFrame>, 2> kFrames = {
      {{"body", TwistFrame::body}, {"world", TwistFrame::world}}};
  visit_rate(visitor, false, twist.angular_rad_s);
  visit_velocity(visitor, "`[x, y, z]`", twist.linear_m_s);
  visit_choice(visitor,
               {"frame",
                "`body`: rate and velocity are along the axes of the body; `world`: along those of "
                "the world, and the velocity is that of the point of the body at the origin of the "
                "world"},
               kFrames, twist.frame);
}

Pose pose_at(const Mounted& mounted, std::int64_t t_ns) {
  const auto at = [t_ns](const auto& carrier) { return carrier.pose_at(t_ns); };
  return std::visit(at, mounted.carrier) * mounted.carrier_from_body;
}

namespace {

Pose pose_at(const ConstantPose& constant, std::int64_t /*t_ns*/) {
  return constant.pose;
}

Pose pose_at(const TimedPoses& poses, std::int64_t t_ns) {
  return poses.pose_at(t_ns);
}

Pose pose_at(const TorqueFreeRotation& tumbling, std::int64_t t_ns) {
  return tumbling.pose_at(t_ns);
}

void require(bool holds, const char* where, const char* found) {
  if (holds) return;
  throw Error({where, found, "finite numbers, and poses that are rigid transforms"});
}

void check(const ConstantPose& constant) {
  require(is_rigid(constant.pose), "constant pose", "not a rigid transform");
}

void check(const ConstantTwist& twist) {
  require(is_rigid(twist.pose), "constant twist, pose", "not a rigid transform");
  require(twist.angular_rad_s.allFinite(), "constant twist, angular velocity", "not finite");
  require(twist.linear_m_s.allFinite(), "constant twist, linear velocity", "not finite");
}

void check(const Spin& spin) {
  require(is_rigid(spin.pose), "spin, pose", "not a rigid transform");
  require(spin.rate_rad_s.allFinite(), "spin, rate", "not finite");
}

/// The motion in another world frame; vectors in world axes are rotated.
Trajectory moved_by(const Pose& moved, const ConstantPose& constant) {
  return ConstantPose{moved * constant.pose};
}

Trajectory moved_by(const Pose& moved, Spin spin) {
  spin.pose = moved * spin.pose;
  return spin;
}

/// A twist in the world frame is transformed by the adjoint map (Lynch and Park, "Modern Robotics"
/// (2017), definition 3.20).
Trajectory moved_by(const Pose& moved, ConstantTwist twist) {
  twist.pose = moved * twist.pose;
  if (twist.frame == TwistFrame::body) return twist;
  twist.angular_rad_s = moved.linear() * twist.angular_rad_s;
  twist.linear_m_s =
      moved.linear() * twist.linear_m_s + moved.translation().cross(twist.angular_rad_s);
  return twist;
}

Trajectory moved_by(const Pose& moved, const TimedPoses& timed) {
  const Eigen::Quaterniond rotation(moved.linear());
  std::vector<TimedPose> poses(timed.poses().begin(), timed.poses().end());
  for (TimedPose& pose : poses) {
    pose.position_m = moved * pose.position_m;
    pose.orientation = rotation * pose.orientation;
  }
  return TimedPoses(std::move(poses), timed.interpolation());
}

Trajectory moved_by(const Pose& moved, const TorqueFreeRotation& tumbling) {
  InitialRotation start = tumbling.start();
  start.world_from_body = moved * start.world_from_body;
  start.velocity_m_s = moved.linear() * start.velocity_m_s;
  return TorqueFreeRotation(start);
}

Trajectory moved_by(const Pose& moved, const Mounted& mounted) {
  const auto move = [&](const auto& carrier) {
    const Trajectory result = moved_by(moved, carrier);
    return Mounted{std::get<std::decay_t<decltype(carrier)>>(result), mounted.carrier_from_body};
  };
  return std::visit(move, mounted.carrier);
}

Trajectory mounted_on(const ConstantPose& body, const Pose& part) {
  return ConstantPose{body.pose * part};
}

/// A twist in the body frame is transformed to the part frame by the adjoint map of part_from_body
/// (Lynch and Park, "Modern Robotics" (2017), definition 3.20); one in the world frame is
/// unchanged.
Trajectory mounted_on(ConstantTwist body, const Pose& part) {
  body.pose = body.pose * part;
  if (body.frame == TwistFrame::world) return body;
  const Eigen::Matrix3d turn = part.linear().transpose();
  body.linear_m_s = turn * (body.linear_m_s + body.angular_rad_s.cross(part.translation()));
  body.angular_rad_s = turn * body.angular_rad_s;
  return body;
}

Trajectory mounted_on(const Spin& body, const Pose& part) {
  return mounted_on(ConstantTwist{.pose = body.pose,
                                  .angular_rad_s = body.rate_rad_s,
                                  .frame = TwistFrame::body,
                                  .t0_ns = body.t0_ns},
                    part);
}

Trajectory mounted_on(const TimedPoses& body, const Pose& part) {
  return Mounted{body, part};
}

Trajectory mounted_on(const TorqueFreeRotation& body, const Pose& part) {
  return Mounted{body, part};
}

Trajectory mounted_on(Mounted body, const Pose& part) {
  body.carrier_from_body = body.carrier_from_body * part;
  return body;
}

void check(const TimedPoses& /*checked when made*/) {}
void check(const TorqueFreeRotation& /*checked when made*/) {}

void check(const Mounted& mounted) {
  require(is_rigid(mounted.carrier_from_body), "mounted, pose", "not a rigid transform");
}

/// The timed poses of a trajectory; nullptr if it has none.
const TimedPoses* timed_poses(const Trajectory& trajectory) {
  const auto* mounted = std::get_if<Mounted>(&trajectory);
  if (mounted != nullptr) return std::get_if<TimedPoses>(&mounted->carrier);
  return std::get_if<TimedPoses>(&trajectory);
}

bool is_linear(const Trajectory& trajectory) {
  const TimedPoses* timed = timed_poses(trajectory);
  constexpr std::size_t kMin = 3;  // two poses have one velocity
  return timed != nullptr && timed->poses().size() >= kMin &&
         timed->interpolation() == Interpolation::linear;
}

std::string seconds_text(std::int64_t t_ns) {
  return decimal_seconds(t_ns) + " s";
}

/// The motion with each of its times shifted from one clock to another.
struct Retimed {
  std::int64_t from_ns;
  std::int64_t to_ns;

  [[nodiscard]] std::int64_t time(std::int64_t t_ns) const {
    return shifted_time_ns(t_ns, from_ns, to_ns);
  }
  ConstantPose operator()(const ConstantPose& constant) const { return constant; }
  ConstantTwist operator()(ConstantTwist twist) const {
    twist.t0_ns = time(twist.t0_ns);
    return twist;
  }
  Spin operator()(Spin spin) const {
    spin.t0_ns = time(spin.t0_ns);
    return spin;
  }
  TimedPoses operator()(TimedPoses timed) const {
    timed.shift_times(from_ns, to_ns);
    return timed;
  }
  TorqueFreeRotation operator()(const TorqueFreeRotation& tumbling) const {
    InitialRotation start = tumbling.start();
    start.t0_ns = time(start.t0_ns);
    return TorqueFreeRotation(start);
  }
  Mounted operator()(Mounted mounted) const {
    std::visit([this](auto& carrier) { carrier = (*this)(carrier); }, mounted.carrier);
    return mounted;
  }
};

}  // namespace

Pose pose_at(const Trajectory& trajectory, std::int64_t t_ns) {
  return std::visit([t_ns](const auto& kind) { return pose_at(kind, t_ns); }, trajectory);
}

void poses_at(const Trajectory& trajectory, std::span<const std::int64_t> t_ns,
              std::span<Pose> out) {
  if (t_ns.size() != out.size()) {
    throw Error({"poses_at", std::to_string(out.size()) + " poses",
                 std::to_string(t_ns.size()) + ", one per time"});
  }
  if (const TimedPoses* timed = timed_poses(trajectory)) {
    timed->poses_at(t_ns, out);
    const auto* mounted = std::get_if<Mounted>(&trajectory);
    if (mounted == nullptr) return;
    for (Pose& pose : out) pose = pose * mounted->carrier_from_body;
    return;
  }
  std::visit(
      [&](const auto& kind) {
        for (std::size_t i = 0; i < t_ns.size(); ++i) out[i] = pose_at(kind, t_ns[i]);
      },
      trajectory);
}

void validate(const Trajectory& trajectory) {
  std::visit([](const auto& kind) { check(kind); }, trajectory);
}

TimeInterval valid_interval(const Trajectory& trajectory) {
  const TimedPoses* timed = timed_poses(trajectory);
  return timed != nullptr ? TimeInterval{timed->first_ns(), timed->last_ns()} : TimeInterval{};
}

void warn_extrapolation(const Trajectory& trajectory, std::string_view name,
                        const TimeInterval& requested, const Report& report) {
  const TimeInterval known = valid_interval(trajectory);
  if (requested.first_ns >= known.first_ns && requested.last_ns <= known.last_ns) return;
  report.warn(std::string(name) + ": the trajectory is defined from " +
              seconds_text(known.first_ns) + " to " + seconds_text(known.last_ns) +
              ", requested is " + seconds_text(requested.first_ns) + " to " +
              seconds_text(requested.last_ns) + "; outside, its first or last pose is used");
}

void warn_linear_interpolation(const Trajectory& trajectory, std::string_view name,
                               const Report& report) {
  if (!is_linear(trajectory)) return;
  report.warn(std::string(name) +
              ": its timed poses are interpolated linearly, so velocities jump at every pose and "
              "the acceleration between poses is 0; inertial sensors need 'interpolation: spline'");
}

Motion static_motion(const Scene& scene, const Pose& world_from_sensor) {
  Motion motion{.world_from_sensor = ConstantPose{world_from_sensor}, .world_from_instance = {}};
  motion.world_from_instance.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) {
    motion.world_from_instance.emplace_back(ConstantPose{instance.world_from_object});
  }
  return motion;
}

Motion make_motion(const Scene& scene, const Trajectory& world_from_sensor,
                   const std::vector<Trajectory>& world_from_instance) {
  Motion motion = static_motion(scene, Pose::Identity());
  motion.world_from_sensor = world_from_sensor;
  if (world_from_instance.empty()) return motion;
  if (world_from_instance.size() != scene.instances.size()) {
    throw Error({"motion", std::to_string(world_from_instance.size()) + " trajectories",
                 std::to_string(scene.instances.size()) + ", one per instance, or none"});
  }
  motion.world_from_instance = world_from_instance;
  return motion;
}

Trajectory transformed(const Pose& moved_from_world, const Trajectory& trajectory) {
  return std::visit([&](const auto& kind) { return moved_by(moved_from_world, kind); }, trajectory);
}

Trajectory retimed(const Trajectory& trajectory, std::int64_t from_ns, std::int64_t to_ns) {
  const Retimed retime{from_ns, to_ns};
  return std::visit([&](const auto& kind) -> Trajectory { return retime(kind); }, trajectory);
}

Trajectory compose_extrinsic(const Trajectory& world_from_body, const Pose& body_from_part) {
  if (body_from_part.matrix() == Pose::Identity().matrix()) return world_from_body;
  return std::visit([&](const auto& kind) { return mounted_on(kind, body_from_part); },
                    world_from_body);
}

void sample_poses(const Motion& motion, Frame& frame) {
  frame.world_from_sensor = pose_at(motion.world_from_sensor, frame.stamp_ns);
  frame.world_from_instance.resize(motion.world_from_instance.size());
  for (std::size_t i = 0; i < motion.world_from_instance.size(); ++i) {
    frame.world_from_instance[i] = pose_at(motion.world_from_instance[i], frame.stamp_ns);
  }
}

}  // namespace glidar
