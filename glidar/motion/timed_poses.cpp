// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/timed_poses.hpp>

#include <glidar/core/error.hpp>
#include <glidar/motion/kinematics.hpp>
#include <glidar/motion/pose_spline.hpp>
#include <glidar/motion/rotation_vector.hpp>
#include <glidar/motion/times.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace glidar {
namespace {

void to_pose(const TimedPose& timed, Pose& pose) {
  pose.linear() = timed.orientation.toRotationMatrix();
  pose.translation() = timed.position_m;
  pose.makeAffine();
}

[[noreturn]] void fail(std::size_t entry, const TimedPoseError& error) {
  throw Error({"timed poses, entry " + std::to_string(entry + 1), error.found, error.allowed});
}

void check(const std::vector<TimedPose>& poses) {
  if (poses.empty()) throw Error({"timed poses", "there is none", "at least one pose"});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (const auto error = find_error(i == 0 ? nullptr : &poses[i - 1], poses[i])) fail(i, *error);
  }
}

}  // namespace

std::optional<TimedPoseError> find_error(const TimedPose* before, const TimedPose& next) {
  using Part = TimedPoseError::Part;
  if (before != nullptr && next.t_ns == before->t_ns) {
    return TimedPoseError{Part::time, "the same time as the previous pose", "increasing times"};
  }
  if (before != nullptr && next.t_ns < before->t_ns) {
    return TimedPoseError{Part::time, "a time before that of the previous pose",
                          "increasing times"};
  }
  if (!is_within_reach(next.position_m)) {
    return TimedPoseError{Part::position, "a position that is not finite or too large",
                          "coordinates up to 1e15 m"};
  }
  const double length = next.orientation.norm();
  if (!(std::abs(length - 1.0) <= kQuaternionTolerance)) {
    return TimedPoseError{Part::orientation, "a quaternion of length " + std::to_string(length),
                          "length 1 to within 0.01"};
  }
  return std::nullopt;
}

TimedPoses::TimedPoses(std::vector<TimedPose> poses, Interpolation interpolation)
    : poses_(std::move(poses)) {
  check(poses_);
  for (TimedPose& pose : poses_) pose.orientation.normalize();
  set_interpolation(interpolation);
}

void TimedPoses::set_interpolation(Interpolation interpolation) {
  if (interpolation == Interpolation::linear) return;
  spline_ = std::make_shared<const PoseSpline>(poses_);
}

TimedPoses TimedPoses::restored(std::vector<TimedPose> poses, Interpolation interpolation) {
  check(poses);
  constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double length = poses[i].orientation.norm();
    if (std::abs(length - 1.0) <= kRounding) continue;
    fail(i, {TimedPoseError::Part::orientation, "a quaternion that is not normalised",
             "a quaternion of length 1"});
  }
  TimedPoses result;
  result.poses_ = std::move(poses);
  result.set_interpolation(interpolation);
  return result;
}

void TimedPoses::shift_times(std::int64_t from_ns, std::int64_t to_ns) {
  // the ends first: nothing changes if one of them is out of range
  (void)shifted_time_ns(first_ns(), from_ns, to_ns);
  (void)shifted_time_ns(last_ns(), from_ns, to_ns);
  for (TimedPose& pose : poses_) pose.t_ns = shifted_time_ns(pose.t_ns, from_ns, to_ns);
}

std::size_t TimedPoses::next_after(std::int64_t t_ns) const {
  const auto later = [](std::int64_t t, const TimedPose& pose) { return t < pose.t_ns; };
  return static_cast<std::size_t>(std::upper_bound(poses_.begin(), poses_.end(), t_ns, later) -
                                  poses_.begin());
}

void TimedPoses::between(std::size_t next, std::int64_t t_ns, Pose& pose) const {
  if (next == 0) return to_pose(poses_.front(), pose);
  const TimedPose& before = poses_[next - 1];
  if (next == poses_.size() || before.t_ns == t_ns) return to_pose(before, pose);
  const TimedPose& after = poses_[next];
  if (spline_) {
    pose = spline_->pose_at(poses_, next - 1, seconds_between(before.t_ns, t_ns));
    return;
  }
  const double fraction =
      seconds_between(before.t_ns, t_ns) / seconds_between(before.t_ns, after.t_ns);
  TimedPose middle;
  middle.position_m = before.position_m + fraction * (after.position_m - before.position_m);
  const RotationArc::Weights weights =
      RotationArc(before.orientation, after.orientation).at(fraction);
  middle.orientation.coeffs() =
      weights.before * before.orientation.coeffs() + weights.after * after.orientation.coeffs();
  middle.orientation.normalize();
  to_pose(middle, pose);
}

Pose TimedPoses::pose_at(std::int64_t t_ns) const {
  Pose pose;
  between(next_after(t_ns), t_ns, pose);
  return pose;
}

KinematicState TimedPoses::state_at(std::int64_t t_ns) const {
  const bool is_moving = poses_.size() > 1 && t_ns >= first_ns() && t_ns <= last_ns();
  if (!is_moving) return {.pose = pose_at(t_ns)};
  const std::size_t before = std::min(next_after(t_ns), poses_.size() - 1) - 1;
  const double since_s = seconds_between(poses_[before].t_ns, t_ns);
  KinematicState state =
      spline_ ? spline_->state_at(poses_, before, since_s) : linear_state(poses_, before);
  state.pose = pose_at(t_ns);
  return state;
}

MaxRates TimedPoses::max_rates(const TimeInterval& interval) const {
  MaxRates rates;
  const std::size_t end = std::min(next_after(interval.last_ns), poses_.size() - 1);
  const std::size_t next = next_after(interval.first_ns);
  for (std::size_t before = next == 0 ? 0 : next - 1; before < end; ++before) {
    MaxRates part;
    if (spline_) {
      part = spline_->max_rates(poses_, before);
    } else {
      const KinematicState state = linear_state(poses_, before);
      part = {state.velocity_m_s.norm(), state.angular_velocity_rad_s.norm()};
    }
    rates = {std::max(rates.linear_m_s, part.linear_m_s),
             std::max(rates.angular_rad_s, part.angular_rad_s)};
  }
  return rates;
}

void TimedPoses::poses_at(std::span<const std::int64_t> t_ns, std::span<Pose> out) const {
  constexpr std::size_t kSteps = 8;  // farther ahead, a binary search is faster
  std::size_t next = 0;
  for (std::size_t i = 0; i < t_ns.size(); ++i) {
    const std::int64_t t = t_ns[i];
    const bool back = next > 0 && t < poses_[next - 1].t_ns;
    const std::size_t stop = std::min(next + kSteps, poses_.size());
    while (!back && next < stop && poses_[next].t_ns <= t) ++next;
    const bool found = !back && (next == poses_.size() || t < poses_[next].t_ns);
    if (!found) next = next_after(t);
    between(next, t, out[i]);
  }
}

}  // namespace glidar
