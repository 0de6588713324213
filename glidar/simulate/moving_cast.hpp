// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/motion/motion.hpp>
#include <glidar/render/renderer.hpp>

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

namespace glidar {

/// A scene in motion, and when a frame of it starts.
struct TimedScene {
  Renderer& renderer;
  const Scene& scene;
  const Motion& motion;
  std::int64_t stamp_ns = 0;
};

/// Memory that casts in one moving scene reuse. N = number of beams.
struct MovingCastWorkspace {
  Beams beams;                                                 ///< as a rigid body sees them
  std::vector<Eigen::Matrix3d> start_from_sensor;              ///< N, as that body sees the sensor
  Hits hits;                                                   ///< on that body
  std::vector<std::uint8_t> instance_enabled;                  ///< per instance
  std::vector<std::optional<Eigen::AlignedBox3d>> mesh_boxes;  ///< per mesh, once it has moved
};

/// True when the sensor or an instance moves.
bool moves(const Motion& motion);

/// True when the beams are fired at different times while something moves.
bool moves_during_frame(const Motion& motion, const Beams& beams);

/// Casts beams of which each sees the scene at its own firing time, exactly, without time steps.
/// All that is static is one rigid body, every moving instance another. For each body the beams are
/// expressed in the frame in which the body is at rest and cast; a beam keeps the nearest hit.
///
/// `request` is that of a static frame: beams in the sensor's frame, poses at stamp_ns. Hits are as
/// if each beam had been cast alone at stamp_ns + times_ns: normals in the sensor's frame of that
/// time, depth along its boresight.
void cast_moving(const TimedScene& scene, const CastRequest& request,
                 MovingCastWorkspace& workspace, Hits& hits);

/// The beams of a request as a rigid body sees them that keeps its pose of stamp_ns, in the sensor
/// frame of that time: an instance, or with kInvalidId all that is static. Beams that cannot hit a
/// moving instance have no direction. They are in the workspace, until the next call.
const Beams& beams_at_rest(const TimedScene& scene, const CastRequest& request,
                           std::uint32_t instance, MovingCastWorkspace& workspace);

/// The reported and the fired beams, which are the same without pointing errors, as seen from the
/// sensor's pose at stamp_ns. Changes nothing when the sensor does not move while they are fired.
void deskew(const TimedScene& scene, const Beams& reported, const Beams& fired,
            Frame::Deskewed& deskewed);

}  // namespace glidar
