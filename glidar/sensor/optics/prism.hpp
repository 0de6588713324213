// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/sensor/optics/firing_schedule.hpp>

namespace glidar {

/// A wedge of glass that turns about the boresight.
struct RisleyPrism {
  enum class Slope : std::uint8_t {
    entry,
    exit
  };  ///< the face that is not square to the boresight

  double rotation_hz = 0.0;       ///< negative: the other way round
  double apex_rad = 0.0;          ///< angle between the faces
  double phase_rad = 0.0;         ///< at time 0
  double refractive_index = 1.5;  ///< of the glass; outside it is 1
  Slope slope = Slope::entry;
};

/// Beams that rotating prisms lead through rosettes (Livox Mid-40, Mid-70, Avia).
struct Prism {
  std::vector<RisleyPrism> prisms;  ///< in the order in which the light passes them
  /// Direction of each beam before the first prism, as the sine of its angle to the right of the
  /// boresight. All fire at once; beam number = row = ring.
  std::vector<double> incidence_tangent = {0.0};
  double pulse_hz = 1e5;  ///< shots per second of each beam
};

/// rows = incident beams, cols = shots in the window in the order of time; shot k is at k/pulse_hz,
/// the prisms go on turning from window to window. Directions by vector refraction at every face
/// (OE 25(7), 2017, DOI 10.1364/OE.25.007677). Frame lidar_frame, boresight +x.
/// A beam that a face reflects totally is no beam. Throws Error when a number is out of range.
Beams make_beams(const Prism& prism, const FrameInterval& window);

}  // namespace glidar
