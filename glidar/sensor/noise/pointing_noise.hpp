// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/field.hpp>

#include <cstddef>

namespace glidar {

class FieldVisitor;
struct Sampler;

// Errors of a beam's direction. They are unknown to the sensor: beams are cast in the erroneous
// direction, and points are reported in the nominal one.

/// Normal errors of each beam's angles, sideways (about the sensor's vertical, on the sphere) and
/// upwards.
struct PointingJitter {
  static constexpr TypeInfo kType = {
      "pointing_jitter", "each beam deviates by normal angles, sideways and upwards on the sphere",
      "RobotecGPULidar, docs/GaussianNoise.md: ray noise before the cast"};
  double sigma_azimuth_rad = 0.0;
  double sigma_elevation_rad = 0.0;
};

/// The angle encoder of a rotating sensor, about the sensor's z axis. Reported minus true azimuth
/// is Q(phi) - phi, where Q rounds to whole steps, plus eccentricity sin(phi + phase), plus a
/// normal error that is the same for a whole frame.
struct EncoderError {
  static constexpr TypeInfo kType = {"encoder_error",
                                     "reported minus true azimuth: rounding to steps + e sin(φ + "
                                     "phase) + one normal number per frame",
                                     "a graduated circle: its steps and its eccentric axis"};
  double step_rad = 0.0;  ///< 0: not rounded
  double eccentricity_rad = 0.0;
  double phase_rad = 0.0;
  double turn_sigma_rad = 0.0;
};

/// Keys in sensor files.
void describe(PointingJitter& step, FieldVisitor& visitor);
void describe(EncoderError& step, FieldVisitor& visitor);

/// Applies the step to the beams [first, first + count); `sampler` is that of beam 0.
void perturb(const PointingJitter& step, const Sampler& sampler, std::size_t first,
             std::size_t count, Beams& beams);
void perturb(const EncoderError& step, const Sampler& sampler, std::size_t first, std::size_t count,
             Beams& beams);

}  // namespace glidar
