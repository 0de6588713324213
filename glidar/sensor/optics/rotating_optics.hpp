// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/field.hpp>
#include <glidar/sensor/optics/firing_schedule.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace glidar {

/// Snell's law for vectors: the unit direction behind a face whose unit normal is opposed to the
/// light; `ratio` is the refractive index before over that behind. NaN for total reflection.
Eigen::Vector3d refract(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal,
                        double ratio);

/// The phase at firing k, in turns, of what rotates `turns_per_firing` turns from one firing to the
/// next. Whole turns are left out, so that phases stay exact after many turns.
double phase_turns(double at_zero_turns, double turns_per_firing, std::int64_t k);

/// Writes the unit directions of all rows at firing k.
using FiringDirections = std::function<void(std::int64_t k, std::span<Eigen::Vector3d> directions)>;

/// Beams that fire together at every event of the schedule: rows = rings = beams, cols = firings in
/// the interval in time order. Frame lidar_frame (x forward, y left, z up), boresight +x.
Beams make_steered_beams(const FiringSchedule& pulses, const FrameInterval& interval,
                         std::size_t rows, const FiringDirections& directions_at);

class FieldVisitor;

/// A wedge prism that rotates about the boresight.
struct RisleyPrism {
  enum class Slope : std::uint8_t {
    entry,
    exit
  };  ///< the face that is not perpendicular to the boresight

  double rotation_hz = 0.0;       ///< revolutions per second; negative: reversed
  double apex_rad = 0.0;          ///< angle between the faces
  double phase_rad = 0.0;         ///< at time 0
  double refractive_index = 1.5;  ///< of the glass; 1 outside
  Slope slope = Slope::entry;
};

/// Beams that rotating prisms steer along rosettes (Livox Mid-40, Mid-70, Avia, Horizon, Tele-15).
struct Prism {
  static constexpr TypeInfo kType = {"prism", "a scanner with rotating prisms"};
  std::vector<RisleyPrism> prisms;  ///< in the order in which the light passes through them
  /// Angle of each beam to the boresight before the first prism. All fire at once; row = ring =
  /// index of the beam.
  std::vector<double> incidence_rad = {0.0};
  double incidence_roll_rad = 0.0;  ///< positive angles point to the right at 0, up at pi/2
  double pulse_hz = 1e5;            ///< firings per second of each beam
};

/// Keys of `optics` in sensor files, and those of each of its `prisms`.
void describe(Prism& prism, FieldVisitor& visitor);
void describe(RisleyPrism& prism, FieldVisitor& visitor);

/// rows = incident beams, cols = firings in the interval in time order; firing k is at k/pulse_hz.
/// The rotation continues from interval to interval. Directions by vector refraction at every face
/// (OE 25(7), 2017, DOI 10.1364/OE.25.007677). Frame lidar_frame (x forward, y left, z up),
/// boresight +x. A totally reflected beam is no beam. Throws Error if a number is out of range.
Beams make_beams(const Prism& prism, const FrameInterval& interval);

class FieldVisitor;

/// What rotates about the vertical axis: the azimuth of its inclined face is
/// phase + 2 pi rotation_hz t + modulation sin(2 pi modulation_hz t), counted to the left.
struct RotatingFace {
  double rotation_hz = 0.0;       ///< revolutions per second; negative: clockwise from above
  double phase_rad = 0.0;         ///< at time 0
  double tilt_rad = 0.0;          ///< angle between the normal of the face and the vertical axis
  double refractive_index = 1.5;  ///< of the glass; 1 outside
  double modulation_rad = 0.0;    ///< amplitude of the periodic deviation from uniform rotation
  double modulation_hz = 0.0;
};

/// Beams that enter from below a rotating wedge, and then a rotating prism whose inclined face
/// reflects them to the side (Livox Mid-360).
struct WedgeMirror {
  static constexpr TypeInfo kType = {"wedge_mirror",
                                     "a scanner with a rotating wedge below a rotating mirror"};
  RotatingFace wedge;   ///< the first face is horizontal, the second one inclined
  RotatingFace mirror;  ///< horizontal entry face, inclined mirror, vertical exit face
  /// Angle of each beam from the vertical axis towards the left (+y), before the wedge. All fire at
  /// once; row = ring = index of the beam.
  std::vector<double> incidence_rad = {0.0};
  double pulse_hz = 5e4;        ///< firings per second of each beam
  double first_pulse_ns = 0.0;  ///< time of firing 0
};

/// Keys of `optics` in sensor files, and those of its `wedge` and `mirror`.
void describe(WedgeMirror& optics, FieldVisitor& visitor);
void describe(RotatingFace& face, FieldVisitor& visitor);

/// rows = incident beams, cols = firings in the interval in time order. The rotation continues from
/// interval to interval. Directions by vector refraction at every face and reflection at the mirror
/// (Born and Wolf, Principles of Optics, 7th ed., 1.5 and 4.6.3). Frame lidar_frame (x forward,
/// y left, z up), boresight +x. A totally reflected beam is no beam. Throws Error if a number is
/// out of range.
Beams make_beams(const WedgeMirror& optics, const FrameInterval& interval);

}  // namespace glidar
