// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/motion/motion.hpp>
#include <glidar/render/renderer.hpp>

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace glidar {

/// A scene in motion, and when a frame of it starts.
struct TimedScene {
  Renderer& renderer;
  const Scene& scene;
  const Motion& motion;
  std::int64_t stamp_ns = 0;
};

/// A beam that may hit a moving instance, as a rigid body sees it that keeps its pose of stamp_ns,
/// in the sensor's frame of that time.
struct BodyBeam {
  std::size_t beam = 0;  ///< index into the request's beams
  std::uint32_t instance = 0;
  Eigen::Vector3d direction;
  Eigen::Vector3d origin_m;
  Eigen::Matrix3d start_from_sensor;  ///< rotation, as that body sees the sensor
};

/// A moving instance during a frame.
struct MovingBody {
  std::uint32_t instance = 0;
  Pose world_from_body = Pose::Identity();  ///< at stamp_ns
  Eigen::AlignedBox3d box_m;                ///< of its surface, in the axes of the body
  // A sphere around all its places during the frame, in the sensor's frame at the start.
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};

/// Memory that searches for body beams reuse.
struct BodyBeamSearch {
  std::vector<std::optional<Eigen::AlignedBox3d>> mesh_boxes;  ///< per mesh, once it has moved
  std::vector<MovingBody> bodies;
  /// Per slice of the beams: index of the first body that was not searched. Empty: a search begins.
  std::vector<std::size_t> next_body;
  /// Results: per slice, by increasing instance. Every beam is in one slice only.
  std::vector<std::vector<BodyBeam>> slices;
};

/// True for a stationary body.
bool is_static(const Trajectory& trajectory);

/// Finds every moving instance that each beam may hit at its own firing time: the beam meets the
/// instance's box there. The cost grows with these pairs, not with the number of instances times
/// that of beams. A call finds some of them, at most about three per beam, in place of those of the
/// call before; false: none is left.
///
/// `request` is that of a static frame: beams in the sensor's frame, poses at stamp_ns. `at_rest`:
/// the beams in the sensor's frame at the start, as all that is static sees them; those without a
/// direction are left out. `nearest_m`, one per beam: hits at this range or beyond do not matter,
/// unless it is NaN; empty: all matter.
bool find_body_beams(const TimedScene& scene, const CastRequest& request, const Beams& at_rest,
                     std::span<const double> nearest_m, BodyBeamSearch& search);

}  // namespace glidar
