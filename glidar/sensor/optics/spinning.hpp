// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/sensor/optics/firing_schedule.hpp>

#include <numbers>

namespace glidar {

/// One laser of a spinning LiDAR. Azimuths count from +x to the left (REP-103: from above, against
/// the clock), elevations from the horizon upwards.
struct SpinningChannel {
  double elevation_rad = 0.0;
  double azimuth_offset_rad = 0.0;  ///< of the beam from where the head points
  double fire_time_ns = 0.0;        ///< since the start of the firing sequence; may be negative
  /// Of the beam's start: outwards along the beam's azimuth, to its left, up.
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  std::uint16_t ring = 0;  ///< the number it goes by in clouds
};

/// A head that turns and fires all of its channels, sequence after sequence.
struct Spinning {
  enum class Turn : std::uint8_t { clockwise, counterclockwise };  ///< seen from above

  std::vector<SpinningChannel> channels;
  double rotation_hz = 10.0;  ///< turns per second
  Turn turn = Turn::clockwise;
  double start_azimuth_rad = 0.0;  ///< where the head points at time 0
  /// Sequences in a turn, started by the encoder at equal angles; 0: started by a clock.
  std::uint32_t columns_per_turn = 0;
  double sequence_ns = 0.0;  ///< from sequence to sequence, if a clock starts them
  /// Beams start this far from the axis, where the head points, and ranges count from the axis
  /// (Ouster: lidar_origin_to_beam_origin).
  double beam_origin_m = 0.0;
  /// The sequences that fire: those that start while the head points into this sector, which
  /// reaches from its first azimuth this far to the left.
  double sector_start_rad = 0.0;
  double sector_width_rad = 2.0 * std::numbers::pi;
};

/// One column per firing sequence whose first shot falls into the window, in the order of time; one
/// row per channel, the highest beam in row 0. Frame lidar_frame, boresight +x.
/// Sequence k starts at t = k T; channel c fires at t + fire_time with the azimuth
///   start -+ 2 pi rotation_hz (t + fire_time) + azimuth_offset.
/// Throws Error when a number is out of range.
Beams make_beams(const Spinning& spinning, const FrameInterval& window);

/// Time from one firing sequence to the next.
double sequence_period_ns(const Spinning& spinning);

}  // namespace glidar
