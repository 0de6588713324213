// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/timed_poses.hpp>

#include <glidar/core/error.hpp>
#include <glidar/motion/kinematics.hpp>
#include <glidar/motion/rotation_vector.hpp>
#include <glidar/motion/times.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glidar {

/// A twice continuously differentiable motion through timed poses. Positions are the natural cubic
/// spline (de Boor, "A Practical Guide to Splines" (1978), chapter IV). Orientations between two
/// entries are R Exp(r(t)) with a cubic r(t), whose coefficients make the body's angular velocity
/// and acceleration continuous (Mayorov, "Smooth attitude interpolation" (2018), the method of
/// scipy.spatial.transform.RotationSpline). At both ends the accelerations are 0. Two poses give
/// constant velocities, identical to linear interpolation except for rounding.
class PoseSpline {
 public:
  /// Throws Error if the rotations between poses are so large that there is no such curve.
  explicit PoseSpline(std::span<const TimedPose> poses);

  /// The pose `since_s` after the entry `before`, which is not the last; poses are those of the
  /// constructor.
  [[nodiscard]] Pose pose_at(std::span<const TimedPose> poses, std::size_t before,
                             double since_s) const;

  /// The same with derivatives.
  [[nodiscard]] KinematicState state_at(std::span<const TimedPose> poses, std::size_t before,
                                        double since_s) const;

  /// Upper bounds of the rates between the entry `before`, which is not the last, and the next.
  [[nodiscard]] MaxRates max_rates(std::span<const TimedPose> poses, std::size_t before) const;

 private:
  std::vector<Eigen::Vector3d> velocity_m_s_;  ///< at each entry, world axes
  std::vector<Eigen::Vector3d> rate_rad_s_;    ///< at each entry, body axes
};

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The change from one entry to the next.
struct Step {
  double duration_s;
  Vector3d change;  ///< of the position, or the rotation vector
};

Step position_step(std::span<const TimedPose> poses, std::size_t i) {
  return {seconds_between(poses[i].t_ns, poses[i + 1].t_ns),
          poses[i + 1].position_m - poses[i].position_m};
}

Step rotation_step(std::span<const TimedPose> poses, std::size_t i) {
  return {seconds_between(poses[i].t_ns, poses[i + 1].t_ns),
          rotation_between(poses[i].orientation, poses[i + 1].orientation)};
}

/// A cubic that starts at 0.
struct Cubic {
  Vector3d first;
  Vector3d second;
  Vector3d third;

  [[nodiscard]] Vector3d value(double s) const { return s * (first + s * (second + s * third)); }
  [[nodiscard]] Vector3d slope(double s) const {
    return first + s * (2.0 * second + 3.0 * s * third);
  }
  [[nodiscard]] Vector3d curvature(double s) const { return 2.0 * second + 6.0 * s * third; }
  /// An upper bound of the slope's length up to `end`: the largest of the Bezier points of this
  /// quadratic, whose convex hull contains it.
  [[nodiscard]] double max_slope(double end) const {
    return std::max({first.norm(), (first + end * second).norm(), slope(end).norm()});
  }
};

/// Hermite's cubic with these slopes at the start and the end.
Cubic make_cubic(const Step& step, const Vector3d& start, const Vector3d& end) {
  const double h = step.duration_s;
  const Vector3d mean = step.change / h;
  return {start, (3.0 * mean - 2.0 * start - end) / h, (start + end - 2.0 * mean) / (h * h)};
}

/// A row of the equations for the slopes at the entries: `below` times the slope before, `diagonal`
/// times the slope and `above` times the slope after are `right`.
template <class Block>
struct SlopeRow {
  Block below;
  Block diagonal;
  Block above;
  Vector3d right = Vector3d::Zero();
};

double inverse_of(double block) {
  return 1.0 / block;
}
Matrix3d inverse_of(const Matrix3d& block) {
  return block.inverse();
}

/// Solves a block tridiagonal system by elimination.
template <class Block, class MakeRow>
std::vector<Vector3d> solve_rows(std::size_t count, const MakeRow& make_row) {
  std::vector<Block> above(count);
  std::vector<Vector3d> slopes(count);
  for (std::size_t i = 0; i < count; ++i) {
    SlopeRow<Block> row = make_row(i);
    if (i > 0) {
      row.diagonal -= row.below * above[i - 1];
      row.right -= row.below * slopes[i - 1];
    }
    const Block inverse = inverse_of(row.diagonal);
    above[i] = inverse * row.above;
    slopes[i] = inverse * row.right;
  }
  for (std::size_t i = count - 1; i > 0; --i) slopes[i - 1] -= above[i - 1] * slopes[i];
  return slopes;
}

/// Continuity of the second derivative of the cubics on both sides of entry i; 0 at the ends.
SlopeRow<double> position_row(std::span<const TimedPose> poses, std::size_t i) {
  SlopeRow<double> row = {0.0, 0.0, 0.0};
  const auto add = [&](const Step& step, double& beside) {
    const double h = step.duration_s;
    row.diagonal += 4.0 / h;
    beside = 2.0 / h;
    row.right += 6.0 / (h * h) * step.change;
  };
  if (i > 0) add(position_step(poses, i - 1), row.below);
  if (i + 1 < poses.size()) add(position_step(poses, i), row.above);
  return row;
}

/// The rate of the rotation vector at the end of a step, from the body's rate there.
Vector3d end_slope(const RotationVector& end, const Vector3d& rate) {
  return end.right_jacobian().inverse() * rate;
}

/// Continuity of the body's angular acceleration at entry i; 0 at the ends. At the start of a step
/// it is r'', at its end J r'' + (d/dt J) r'. The last term is nonlinear; it is taken from `rates`.
SlopeRow<Matrix3d> rotation_row(std::span<const TimedPose> poses,
                                const std::vector<Vector3d>& rates, std::size_t i) {
  SlopeRow<Matrix3d> row = {Matrix3d::Zero(), Matrix3d::Zero(), Matrix3d::Zero()};
  const auto add = [&](const Step& step) {
    row.diagonal += 4.0 / step.duration_s * Matrix3d::Identity();
    row.right += 6.0 / (step.duration_s * step.duration_s) * step.change;
  };
  if (i > 0) {
    const Step step = rotation_step(poses, i - 1);
    const RotationVector end(step.change);
    add(step);
    row.below = 2.0 / step.duration_s * end.right_jacobian();
    row.right -= end.jacobian_rate(end_slope(end, rates[i]));
  }
  if (i + 1 < poses.size()) {
    const Step step = rotation_step(poses, i);
    add(step);
    row.above = 2.0 / step.duration_s * RotationVector(step.change).right_jacobian().inverse();
  }
  return row;
}

double largest(const std::vector<Vector3d>& vectors, const std::vector<Vector3d>& others) {
  double largest = 0.0;
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const double size = (vectors[i] - others[i]).cwiseAbs().maxCoeff();
    if (!(size <= largest)) largest = size;  // also NaN
  }
  return largest;
}

[[noreturn]] void refuse(const std::string& found) {
  throw Error({"timed poses, interpolation", found,
               "orientations that are close to each other for a spline",
               "add poses between them, or use linear interpolation"});
}

/// Mayorov's iteration: the nonlinear terms are those of the previous rates.
std::vector<Vector3d> solve_rotation(std::span<const TimedPose> poses) {
  constexpr int kMaxIterations = 100;
  constexpr double kRelative = 1e-13;
  const std::vector<Vector3d> zero(poses.size(), Vector3d::Zero());
  std::vector<Vector3d> rates = zero;
  for (int k = 0; k < kMaxIterations; ++k) {
    const auto row = [&](std::size_t i) { return rotation_row(poses, rates, i); };
    std::vector<Vector3d> next = solve_rows<Matrix3d>(poses.size(), row);
    const double change = largest(next, rates);
    rates = std::move(next);
    if (change <= kRelative * largest(rates, zero)) return rates;
  }
  refuse("rotations between poses without a smooth curve");
}

/// Throws Error if a rotation vector within a step may be too long for RotationVector.
void check_lengths(std::span<const TimedPose> poses, const std::vector<Vector3d>& rates) {
  constexpr double kMax_rad = 10.0;
  constexpr double kHermite = 4.0 / 27.0;  // maximum of the cubics of the slopes
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    const Step step = rotation_step(poses, i);
    const RotationVector end(step.change);
    const double slopes = rates[i].norm() + end_slope(end, rates[i + 1]).norm();
    const double bound = step.change.norm() + kHermite * step.duration_s * slopes;
    if (!(bound <= kMax_rad)) {
      refuse("a rotation of " + std::to_string(bound) + " rad after entry " +
             std::to_string(i + 1));
    }
  }
}

/// The position from an entry on, relative to it.
Cubic position_after(std::span<const TimedPose> poses, const std::vector<Vector3d>& velocities,
                     std::size_t before) {
  return make_cubic(position_step(poses, before), velocities[before], velocities[before + 1]);
}

/// The rotation vector from an entry on.
Cubic rotation_after(std::span<const TimedPose> poses, const std::vector<Vector3d>& rates,
                     std::size_t before) {
  const Step turn = rotation_step(poses, before);
  return make_cubic(turn, rates[before], end_slope(RotationVector(turn.change), rates[before + 1]));
}

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

PoseSpline::PoseSpline(std::span<const TimedPose> poses) {
  if (poses.size() < 2) return;
  velocity_m_s_ =
      solve_rows<double>(poses.size(), [&](std::size_t i) { return position_row(poses, i); });
  rate_rad_s_ = solve_rotation(poses);
  check_lengths(poses, rate_rad_s_);
}

/// A body turns no faster than its rotation vector changes: the norm of the Jacobian is at most 1.
MaxRates PoseSpline::max_rates(std::span<const TimedPose> poses, std::size_t before) const {
  const double duration_s = position_step(poses, before).duration_s;
  return {position_after(poses, velocity_m_s_, before).max_slope(duration_s),
          rotation_after(poses, rate_rad_s_, before).max_slope(duration_s)};
}

Pose PoseSpline::pose_at(std::span<const TimedPose> poses, std::size_t before,
                         double since_s) const {
  return state_at(poses, before, since_s).pose;
}

KinematicState PoseSpline::state_at(std::span<const TimedPose> poses, std::size_t before,
                                    double since_s) const {
  const TimedPose& from = poses[before];
  const Cubic position = position_after(poses, velocity_m_s_, before);
  const Cubic vector = rotation_after(poses, rate_rad_s_, before);
  const RotationVector rotation(vector.value(since_s));
  const Vector3d slope = vector.slope(since_s);
  KinematicState state;
  state.pose.linear() = from.orientation.toRotationMatrix() * rotation.matrix();
  state.pose.translation() = from.position_m + position.value(since_s);
  state.velocity_m_s = position.slope(since_s);
  state.acceleration_m_s2 = position.curvature(since_s);
  state.angular_velocity_rad_s = rotation.angular_velocity(slope);
  state.angular_acceleration_rad_s2 =
      rotation.angular_velocity(vector.curvature(since_s)) + rotation.jacobian_rate(slope);
  return state;
}

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
