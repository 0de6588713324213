// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/direction_grid.hpp>
#include <glidar/simulate/moving_cast.hpp>
#include <glidar/simulate/prepared_sensor.hpp>
#include <glidar/simulate/return_replacement.hpp>
#include <glidar/simulate/waveform_trace.hpp>

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

namespace glidar {

/// Beams that are cast beside those of the sensor: sub-rays of pulses, beams from a projector.
struct SubRayWorkspace {
  std::size_t first_pulse = 0;  ///< whose sub-rays come first
  Beams beams;
  Hits hits;                                 ///< of `beams`
  std::vector<double> signals;               ///< per sub-ray: its signal alone
  Beams mirrored;                            ///< beams reflected by mirrors
  Hits mirrored_hits;                        ///< of `mirrored`
  std::vector<std::uint32_t> mirrored_from;  ///< per mirrored beam: its sub-ray
};

/// What boxes of objects are found with.
struct BoxWorkspace {
  std::vector<std::optional<Eigen::AlignedBox3d>> mesh_boxes;  ///< per mesh, once it is needed
  Beams nominal;                        ///< one per firing, when pulses have several returns
  Hits nominal_hits;                    ///< of the nominal beams
  MovingCastWorkspace moving;           ///< the beams as the object sees them
  DirectionGrid grid;                   ///< of the beams as the objects see them
  std::vector<std::uint32_t> near;      ///< firings whose beams pass near an object
  std::vector<std::uint8_t> crosses;    ///< per firing: whether its beam may hit this object
  std::vector<std::uint32_t> crossing;  ///< such firings of several objects, one after the other
  std::vector<std::uint32_t> owners;    ///< per firing: the instance for which it is cast
  std::vector<std::uint32_t> owned;     ///< the firings that have an owner, ascending
  std::vector<std::uint8_t> is_object;  ///< per instance: whether beams are cast into it
  std::vector<std::uint8_t> hides;      ///< per instance: whether it hides an owner from its beam
  std::vector<std::uint32_t> hidden;    ///< per instance: beams that hit it behind others
  Beams candidates;                     ///< the beams of the firings with an owner
  Hits hits;                            ///< of the candidates
};

/// Memory that simulations of one sensor in one scene reuse from frame to frame.
struct Workspace {
  Beams fired;  ///< the sensor's beams with their pointing errors
  NoiseWorkspace noise;
  MovingCastWorkspace moving_cast;
  SubRayWorkspace sub_rays;
  BoxWorkspace boxes;
};

/// One frame to be simulated: what is measured, with what, and where the result is written.
struct Simulation {
  const Scene& scene;
  const PreparedSensor& prepared;
  Renderer& renderer;
  const Beams& beams;  ///< as the sensor reports them
  const Motion& motion;
  HitColumnMask hit_columns;  ///< ground truth that the frame keeps
  Workspace& workspace;
  Frame& frame;
  ProgressCallback progress;
  const ReturnReplacement& replace_returns;
  bool is_moving = moves_during_frame(motion, beams);
  const Beams* fired = &beams;               ///< the beams with their pointing errors
  std::size_t noise_steps = kMaxNoiseSteps;  ///< how many of them are applied
  WaveformTrace* trace = nullptr;            ///< of a pulse; nullptr: none
};

/// The scene of the frame.
TimedScene timed_scene(const Simulation& s);

/// A cast of beams from the sensor's pose at the frame's start.
CastRequest cast_request(const Simulation& s, const Beams& beams, const HitColumnMask& hit_columns);

/// Casts the request, each beam at its own firing time where something moves.
void cast(const Simulation& s, const CastRequest& request, Hits& hits);

}  // namespace glidar
