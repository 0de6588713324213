// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/math/random.hpp>

namespace glidar {

// Errors of where a beam goes. The sensor does not know them: the beams are cast astray, and the
// points are reported where the beams should have gone.

/// Each beam goes astray by normal angles, sideways (about the sensor's vertical, on the sphere)
/// and upwards.
struct PointingJitter {
  double sigma_azimuth_rad = 0.0;
  double sigma_elevation_rad = 0.0;
};

/// A turning sensor's angle encoder, about the sensor's z axis. Reported minus true azimuth is
/// Q(phi) - phi, Q rounding to whole steps, plus eccentricity sin(phi + phase), plus a normal error
/// that is the same for a whole frame.
struct EncoderError {
  double step_rad = 0.0;  ///< 0: not rounded
  double eccentricity_rad = 0.0;
  double phase_rad = 0.0;
  double turn_sigma_rad = 0.0;
};

/// Error of the reported azimuth without the frame's own part.
double encoder_error_rad(const EncoderError& law, double azimuth_rad);

/// Turns beams [first, first + count) of `beams` as the step says; `draw` is that of beam 0.
void perturb(const PointingJitter& step, const RngKey& draw, std::size_t first, std::size_t count,
             Beams& beams);
void perturb(const EncoderError& step, const RngKey& draw, std::size_t first, std::size_t count,
             Beams& beams);

}  // namespace glidar
