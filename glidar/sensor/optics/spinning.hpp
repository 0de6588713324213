// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/field.hpp>
#include <glidar/sensor/optics/firing_schedule.hpp>

#include <numbers>
#include <optional>

namespace glidar {

class FieldVisitor;

/// One laser of a spinning LiDAR. Azimuths are from +x towards +y (REP-103: counterclockwise from
/// above), elevations towards +z.
struct SpinningChannel {
  double elevation_rad = 0.0;
  double azimuth_offset_rad = 0.0;  ///< of the beam relative to the head
  double fire_time_ns = 0.0;        ///< since the start of the firing sequence; may be negative
  /// Origin of the beam: outwards along the beam's azimuth, to its left, up.
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  /// What drivers add to the distances of packets: these are the range minus this correction.
  double distance_correction_m = 0.0;
  std::uint16_t ring = 0;  ///< channel number in clouds
};

/// A firing sequence of some of the channels, at times of its own.
struct FiringLoop {
  std::vector<std::uint32_t> channels;  ///< indices into Spinning::channels, each at most once
  std::vector<double> fire_times_ns;    ///< of these channels, since the start of the sequence
};

/// A rotating head that fires all channels, sequence after sequence.
struct Spinning {
  static constexpr TypeInfo kType = {"spinning", "a rotating LiDAR with one beam per channel"};
  enum class RotationDirection : std::uint8_t { clockwise, counterclockwise };  ///< seen from above

  std::vector<SpinningChannel> channels;
  double rotation_hz = 10.0;  ///< revolutions per second
  RotationDirection rotation_direction = RotationDirection::clockwise;
  /// Azimuth of the head at time 0. Empty: such that time 0 starts a sweep of the sector; 0 for a
  /// whole turn.
  std::optional<double> start_azimuth_rad = {};
  /// Firing sequences per revolution, triggered by the encoder at equal angles; 0: by a clock.
  std::uint32_t columns_per_turn = 0;
  double firing_period_ns = 0.0;  ///< period of the sequences, if triggered by a clock
  /// Distance of the beam origins from the axis along the head's azimuth; ranges are measured from
  /// the axis (Ouster: lidar_origin_to_beam_origin).
  double beam_origin_m = 0.0;
  /// Height of these origins; ranges are then longer by their distance from the sensor's origin.
  double beam_origin_height_m = 0.0;
  /// Sequences fire only while the head's azimuth is in this sector: from its first azimuth, its
  /// width to the left. Both ends belong to it, also when they are rounded by up to a thousandth of
  /// the angle between sequences.
  double azimuth_start_rad = 0.0;
  double azimuth_width_rad = 2.0 * std::numbers::pi;
  /// Loops that take turns: sequence k fires loop k mod n. Empty: every sequence fires all channels
  /// at their own fire times.
  std::vector<FiringLoop> firing_loops;
};

/// Maximum number of columns per turn.
inline constexpr std::uint32_t kMaxColumnsPerTurn = 1U << 20U;

/// Keys of `optics` in sensor files.
void describe(Spinning& spinning, FieldVisitor& visitor);
void describe(FiringLoop& loop, FieldVisitor& visitor);

/// One column per firing sequence whose first firing is in the interval, in time order; one row per
/// channel, the highest beam in row 0. Frame lidar_frame (x forward, y left, z up), boresight +x.
/// Sequence k starts at t = k T; channel c fires at t + fire_time with the azimuth
///   start -+ 2 pi rotation_hz (t + fire_time) + azimuth_offset.
/// A channel that does not fire in a sequence has no beam there (NaN).
/// Throws Error when a number is out of range.
Beams make_beams(const Spinning& spinning, const FrameInterval& interval);

/// What a reported range is longer than the beam: the distance of the beam origins from the
/// sensor's origin (ouster-sdk, xyzlut.cpp).
double range_offset_m(const Spinning& spinning);

/// Period of the firing sequences, nanoseconds.
double sequence_period_ns(const Spinning& spinning);

/// Whether the head is in the sector at the start of sequence k, which may be negative.
bool is_in_sector(const Spinning& spinning, std::int64_t k);

/// Azimuth of the head at time 0.
double azimuth_at_start_rad(const Spinning& spinning);

inline constexpr std::size_t kMaxChannels = 4096;

/// The lists of one number per channel, from which a reader makes the channels.
void visit_channels(FieldVisitor& visitor, std::vector<SpinningChannel>& channels);

/// How the rings of channels count.
enum class ChannelOrder : std::uint8_t { as_listed, rising_elevation };

/// Empty: in an order of their own.
std::optional<ChannelOrder> channel_order_of(const std::vector<SpinningChannel>& channels);
void number_rings(ChannelOrder order, std::vector<SpinningChannel>& channels);

/// The sector in degrees, or in radians where no two numbers in degrees give the same bits.
void visit_azimuth_range(FieldVisitor& visitor, Spinning& spinning);

}  // namespace glidar
