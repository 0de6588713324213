// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/simulate/body_beams.hpp>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// Memory that casts in one moving scene reuse. N = number of beams, P = of body beams.
struct MovingCastWorkspace {
  Beams beams;                                     ///< as all that is static sees them
  std::vector<Eigen::Matrix3d> start_from_sensor;  ///< N, as that sees the sensor
  std::vector<std::uint8_t> instance_enabled;      ///< per instance: whether it is static
  BodyBeamSearch search;
  std::vector<std::size_t> first_of_slice;  ///< per slice of the search, and P
  Beams body_beams;                         ///< P
  std::vector<InstanceRange> targets;       ///< P
  Hits body_hits;                           ///< P
};

/// True when the sensor or an instance moves.
bool moves(const Motion& motion);

/// True when the beams are fired at different times while something moves.
bool moves_during_frame(const Motion& motion, const Beams& beams);

/// Casts beams of which each sees the scene at its own firing time, exactly, without time steps.
/// All that is static is cast first, with the beams expressed in the sensor's frame at the start.
/// Then every beam is cast into the moving instances whose boxes it meets at its firing time,
/// expressed in the frame in which the instance is at rest. A beam keeps the nearest hit.
///
/// `request` is that of a static frame: beams in the sensor's frame, poses at stamp_ns. Hits are as
/// if each beam had been cast alone at stamp_ns + times_ns: normals in the sensor's frame of that
/// time, depth along its boresight.
void cast_moving(const TimedScene& scene, const CastRequest& request,
                 MovingCastWorkspace& workspace, Hits& hits);

/// The beams of a request in the sensor's frame at stamp_ns, as all that is static sees them. They
/// are in the workspace, until the next call.
const Beams& beams_at_rest(const TimedScene& scene, const CastRequest& request,
                           MovingCastWorkspace& workspace);

/// Adds to `count`, per instance, the beams of a request that would hit it if it were alone, for
/// moving instances.
void count_body_hits(const TimedScene& scene, const CastRequest& request,
                     MovingCastWorkspace& workspace, std::span<std::uint32_t> count);

/// The reported and the fired beams, which are the same without pointing errors, as seen from the
/// sensor's pose at stamp_ns. Changes nothing when the sensor does not move while they are fired.
void deskew(const TimedScene& scene, const Beams& reported, const Beams& fired,
            Frame::Deskewed& deskewed);

}  // namespace glidar
