// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/field.hpp>
#include <glidar/sensor/optics/firing_schedule.hpp>

#include <vector>

namespace glidar {

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
