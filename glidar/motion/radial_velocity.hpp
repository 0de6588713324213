// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/motion/kinematics.hpp>

#include <cstdint>
#include <optional>
#include <span>

namespace glidar {

/// A point on a beam, in the sensor's frame at the firing time.
struct BeamPoint {
  std::int64_t t_ns = 0;  ///< firing time
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit vector
  double range_m = 0.0;                                 ///< from the origin
};

/// The point at a range on one of the beams of a frame that starts at stamp_ns.
BeamPoint beam_point(const Beams& beams, std::size_t beam, std::int64_t stamp_ns, double range_m);

/// The rate at which the distance between the beam's origin and the point grows, m/s: d . (v_P -
/// v_O), the derivative of |P - O|. The origin is fixed to the sensor, the point to the object, so
/// both have the velocity v + w x r of their rigid body (Siciliano et al., "Robotics: Modelling,
/// Planning and Control" (2009), section 3.1.1). Positive for what moves away, which is the sign of
/// the range rate of radars and of Aeva's FMCW LiDARs (aevainc/carla-aeva, FMCWLidar.cpp,
/// ComputeDopplerVelocity). Exactly 0 between bodies at rest.
double radial_velocity_m_s(const KinematicState& sensor, const KinematicState& object,
                           const BeamPoint& point);

/// The radial velocities of what a sensor's beams hit, from the exact derivatives of all
/// trajectories at the firing times. For one thread: it keeps the last states, which consecutive
/// beams often share.
class RadialVelocities {
 public:
  /// The motion must outlive it.
  explicit RadialVelocities(const Motion& motion) : motion_(motion) {}

  /// Of a point that is fixed to an instance of the scene; kInvalidId: to the world, like still
  /// air.
  double at(const BeamPoint& point, std::uint32_t instance);

 private:
  struct KnownState {
    std::optional<std::int64_t> t_ns = {};  ///< empty: none yet
    std::uint32_t instance = kInvalidId;
    KinematicState state;
  };

  const Motion& motion_;
  KnownState sensor_;
  KnownState object_;
};

/// Fills [range.begin, range.end) of `velocities_m_s` with the radial velocities of what the beams
/// of a frame that starts at stamp_ns hit; NaN for a miss.
void find_radial_velocities(const Motion& motion, const Beams& beams, std::int64_t stamp_ns,
                            const Hits& hits, BeamRange range, std::span<double> velocities_m_s);

/// If `wanted`, fills frame.true_radial_velocity_m_s from ranges and instances of
/// frame.ground_truth on the beams as fired; else clears it.
void record_radial_velocities(const Motion& motion, const Beams& fired, bool wanted,
                              ThreadPool& thread_pool, Frame& frame);

}  // namespace glidar
