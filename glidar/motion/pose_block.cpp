// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/pose_block.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/motion/rotation_vector.hpp>
#include <glidar/motion/times.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace glidar {
namespace {

/// The weights of two poses at the times [begin, end) of a block.
struct InterpolationWeights {
  std::size_t begin;
  std::size_t end;
  PoseBlock::Component fraction;  ///< of the time between them
  PoseBlock::Component before;    ///< of the quaternions
  PoseBlock::Component after;
};

GLIDAR_SIMD void weigh(const RotationArc& arc, InterpolationWeights& weights) {
  for (std::size_t i = weights.begin; i < weights.end; ++i) {
    const RotationArc::Weights at = arc.at(weights.fraction[i]);
    weights.before[i] = at.before;
    weights.after[i] = at.after;
  }
}

/// position = before + fraction (after - before)
GLIDAR_SIMD void interpolate_positions(const TimedPose& before, const TimedPose& after,
                                       const InterpolationWeights& weights, PoseBlock& out) {
  for (int axis = 0; axis < 3; ++axis) {
    const double from = before.position_m[axis];
    const double step = after.position_m[axis] - from;
    PoseBlock::Component& position = out.position_m[static_cast<std::size_t>(axis)];
    for (std::size_t i = weights.begin; i < weights.end; ++i) {
      position[i] = from + weights.fraction[i] * step;
    }
  }
}

/// The normalised weighted sums of two quaternions, as matrices. The order of the operations is
/// that of Eigen's quaternions.
GLIDAR_SIMD void interpolate_rotations(const Eigen::Quaterniond& before,
                                       const Eigen::Quaterniond& after,
                                       const InterpolationWeights& weights, PoseBlock& out) {
  const std::array<double, 4> p = {before.x(), before.y(), before.z(), before.w()};
  const std::array<double, 4> q = {after.x(), after.y(), after.z(), after.w()};
  auto& r = out.rotation;
  for (std::size_t i = weights.begin; i < weights.end; ++i) {
    const double a = weights.before[i];
    const double b = weights.after[i];
    double x = a * p[0] + b * q[0];
    double y = a * p[1] + b * q[1];
    double z = a * p[2] + b * q[2];
    double w = a * p[3] + b * q[3];
    const double length = std::sqrt((x * x + z * z) + (y * y + w * w));
    x /= length;
    y /= length;
    z /= length;
    w /= length;
    const double tx = 2.0 * x;
    const double ty = 2.0 * y;
    const double tz = 2.0 * z;
    r[0][i] = 1.0 - (ty * y + tz * z);
    r[1][i] = ty * x + tz * w;
    r[2][i] = tz * x - ty * w;
    r[3][i] = ty * x - tz * w;
    r[4][i] = 1.0 - (tx * x + tz * z);
    r[5][i] = tz * y + tx * w;
    r[6][i] = tz * x + ty * w;
    r[7][i] = tz * y - tx * w;
    r[8][i] = 1.0 - (tx * x + ty * y);
  }
}

/// Timed poses with the interval that encloses a time.
class Interval {
 public:
  explicit Interval(const TimedPoses& timed) : timed_(timed), poses_(timed.poses()) {}

  void find(std::int64_t t_ns) {
    if (encloses(t_ns)) return;
    const auto is_before = [](std::int64_t t, const TimedPose& pose) { return t < pose.t_ns; };
    next_ = static_cast<std::size_t>(
        std::upper_bound(poses_.begin(), poses_.end(), t_ns, is_before) - poses_.begin());
  }

  [[nodiscard]] bool encloses(std::int64_t t_ns) const {
    return (next_ == 0 || poses_[next_ - 1].t_ns <= t_ns) &&
           (next_ == poses_.size() || t_ns < poses_[next_].t_ns);
  }

  /// The poses `first` and following of a block, at times that the interval encloses.
  void interpolate(std::span<const std::int64_t> t_ns, std::size_t first, PoseBlock& out) const {
    const bool is_between = next_ > 0 && next_ < poses_.size();
    if (is_between) interpolate(poses_[next_ - 1], poses_[next_], t_ns, first, out);
    for (std::size_t i = 0; i < t_ns.size(); ++i) {
      if (is_between && poses_[next_ - 1].t_ns != t_ns[i]) continue;
      out.set(first + i, timed_.pose_at(t_ns[i]));
    }
  }

 private:
  static void interpolate(const TimedPose& before, const TimedPose& after,
                          std::span<const std::int64_t> t_ns, std::size_t first, PoseBlock& out) {
    InterpolationWeights weights;
    weights.begin = first;
    weights.end = first + t_ns.size();
    const double duration = seconds_between(before.t_ns, after.t_ns);
    for (std::size_t i = 0; i < t_ns.size(); ++i) {
      weights.fraction[first + i] = seconds_between(before.t_ns, t_ns[i]) / duration;
    }
    weigh({before.orientation, after.orientation}, weights);
    interpolate_positions(before, after, weights, out);
    interpolate_rotations(before.orientation, after.orientation, weights, out);
  }

  const TimedPoses& timed_;
  std::span<const TimedPose> poses_;
  std::size_t next_ = 0;  ///< the first pose after the interval
};

void poses_at(const TimedPoses& timed, std::span<const std::int64_t> t_ns, PoseBlock& out) {
  Interval interval(timed);
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < t_ns.size(); begin = end) {
    interval.find(t_ns[begin]);
    end = begin + 1;
    while (end < t_ns.size() && interval.encloses(t_ns[end])) ++end;
    interval.interpolate(t_ns.subspan(begin, end - begin), begin, out);
  }
}

}  // namespace

void poses_at(const Trajectory& trajectory, std::span<const std::int64_t> t_ns, PoseBlock& out) {
  if (t_ns.size() > PoseBlock::kSize) {
    throw Error({"poses_at", std::to_string(t_ns.size()) + " times",
                 "at most " + std::to_string(PoseBlock::kSize), ""});
  }
  const auto* timed = std::get_if<TimedPoses>(&trajectory);
  if (timed != nullptr && timed->interpolation() == Interpolation::linear) {
    return poses_at(*timed, t_ns, out);
  }
  std::array<Pose, PoseBlock::kSize> poses;
  poses_at(trajectory, t_ns, std::span<Pose>(poses.data(), t_ns.size()));
  for (std::size_t i = 0; i < t_ns.size(); ++i) out.set(i, poses[i]);
}

}  // namespace glidar
