// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/field.hpp>
#include <glidar/sensor/optics/firing_schedule.hpp>

namespace glidar {

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

}  // namespace glidar
