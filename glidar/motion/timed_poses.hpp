// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar {

/// A pose at a time, as files hold it.
struct TimedPose {
  std::int64_t t_ns = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// What keeps a pose from following another, and which part of it.
struct TimedPoseError {
  enum class Part : std::uint8_t { time, position, orientation };
  Part part = Part::time;
  std::string found;
  std::string allowed;
};

/// How far from 1 the length of a quaternion may be: files of four decimals pass, a forgotten or
/// misplaced component does not.
inline constexpr double kQuaternionTolerance = 1e-3;

/// The first fault of `next`, if it has any; `before` is the pose before it, nullptr for the first.
std::optional<TimedPoseError> find_error(const TimedPose* before, const TimedPose& next);

/// Poses at increasing times. Between them the position goes straight and the orientation turns
/// about one axis at one rate, the short way (slerp: Shoemake, SIGGRAPH 1985). Before the first and
/// after the last time their poses hold.
class TimedPoses {
 public:
  /// Quaternions are normalised. Throws Error naming the entry (counted from 1) when there is none,
  /// times do not increase, a number is not finite or too large, or a quaternion is not of
  /// length 1.
  explicit TimedPoses(std::vector<TimedPose> poses);

  /// The same of poses() of another, whose quaternions are kept to the bit. Throws Error also when
  /// one is not normalised.
  static TimedPoses restored(std::vector<TimedPose> poses);

  [[nodiscard]] Pose pose_at(std::int64_t t_ns) const;

  /// The same for many times; quick when they increase.
  void poses_at(std::span<const std::int64_t> t_ns, std::span<Pose> out) const;

  [[nodiscard]] std::int64_t first_ns() const { return poses_.front().t_ns; }
  [[nodiscard]] std::int64_t last_ns() const { return poses_.back().t_ns; }
  [[nodiscard]] std::span<const TimedPose> poses() const { return poses_; }

 private:
  TimedPoses() = default;

  [[nodiscard]] std::size_t next_after(std::int64_t t_ns) const;
  /// The pose between entry next - 1 and entry next, which are those around t_ns.
  void between(std::size_t next, std::int64_t t_ns, Pose& pose) const;

  std::vector<TimedPose> poses_;  ///< at least one
};

}  // namespace glidar
