// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar {

class PoseSpline;
struct KinematicState;
struct MaxRates;
struct TimeInterval;

/// A pose at a time, as files store it.
struct TimedPose {
  std::int64_t t_ns = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// Why a pose cannot follow another, and its invalid part.
struct TimedPoseError {
  enum class Part : std::uint8_t { time, position, orientation };
  Part part = Part::time;
  std::string found;
  std::string allowed;
};

/// Maximum deviation of a quaternion's length from 1: files with two decimals are valid, a missing
/// or misplaced component is not.
inline constexpr double kQuaternionTolerance = 1e-2;

/// The first error of `next`, if any; `before` is the previous pose, nullptr for the first.
std::optional<TimedPoseError> find_error(const TimedPose* before, const TimedPose& next);

/// How poses between two entries are computed.
enum class Interpolation : std::uint8_t {
  /// Positions along straight lines, orientations along the shorter arc at a constant rate (slerp:
  /// Shoemake, SIGGRAPH 1985). Velocities jump at the entries.
  linear,
  /// Cubic splines through all entries, of positions and of rotation vectors.
  /// Velocities, rates and their derivatives are continuous, as inertial sensors need.
  spline,
};

/// Poses at increasing times, interpolated between them. Before the first and after the last time,
/// the pose is constant.
class TimedPoses {
 public:
  /// Normalises the quaternions. Throws Error with the entry (counted from 1) if there is no pose,
  /// times do not increase, a number is not finite or too large, or the length of a quaternion is
  /// not 1; also if the orientations have no spline.
  explicit TimedPoses(std::vector<TimedPose> poses,
                      Interpolation interpolation = Interpolation::linear);

  /// The same from poses() of another object; quaternions stay bit-identical. Throws Error also if
  /// one is not normalised.
  static TimedPoses restored(std::vector<TimedPose> poses,
                             Interpolation interpolation = Interpolation::linear);

  /// Shifts all times, so that `from_ns` becomes `to_ns`. Throws Error if one leaves the range of
  /// nanoseconds.
  void shift_times(std::int64_t from_ns, std::int64_t to_ns);

  [[nodiscard]] Pose pose_at(std::int64_t t_ns) const;

  /// The same for many times; fast if they increase.
  void poses_at(std::span<const std::int64_t> t_ns, std::span<Pose> out) const;

  /// The pose and its derivatives. At an entry they are those of the interval that begins there, at
  /// the last entry those of the interval that ends there; outside, the body is at rest.
  [[nodiscard]] KinematicState state_at(std::int64_t t_ns) const;

  /// Upper bounds of the rates during an interval.
  [[nodiscard]] MaxRates max_rates(const TimeInterval& interval) const;

  [[nodiscard]] std::int64_t first_ns() const { return poses_.front().t_ns; }
  [[nodiscard]] std::int64_t last_ns() const { return poses_.back().t_ns; }
  [[nodiscard]] std::span<const TimedPose> poses() const { return poses_; }
  [[nodiscard]] Interpolation interpolation() const {
    return spline_ ? Interpolation::spline : Interpolation::linear;
  }

 private:
  TimedPoses() = default;

  [[nodiscard]] std::size_t next_after(std::int64_t t_ns) const;
  /// The pose between the entries next - 1 and next, which enclose t_ns.
  void between(std::size_t next, std::int64_t t_ns, Pose& pose) const;
  void set_interpolation(Interpolation interpolation);

  std::vector<TimedPose> poses_;              ///< at least one
  std::shared_ptr<const PoseSpline> spline_;  ///< nullptr: linear; copies share it
};

}  // namespace glidar
