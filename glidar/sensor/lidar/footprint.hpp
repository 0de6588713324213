// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/math/thread_pool.hpp>

#include <vector>

namespace glidar {

class FieldVisitor;

/// The cross-section of a beam: a Gaussian, given by its full widths where the irradiance is 1/e^2
/// of the maximum. The width at range R is sqrt(exit^2 + (divergence R)^2), horizontally (x) and
/// upwards (y) in the sensor frame.
struct Footprint {
  double divergence_x_rad = 0.0;
  double divergence_y_rad = 0.0;
  double exit_x_m = 0.0;
  double exit_y_m = 0.0;
  unsigned rings = 2;  ///< rings of sub-rays around the central one: 6, 12, 18, ... rays
};

inline constexpr unsigned kMaxRings = 8;

/// Full width at 1/e^2 of a Gaussian beam divided by its full width at half maximum: sqrt(2 / ln
/// 2).
inline constexpr double kWidthPerFwhm = 1.6986436005760381;

/// Throws Error with the number that is out of range.
void validate(const Footprint& footprint);

/// Keys of `footprint` in sensor files.
void describe(Footprint& footprint, FieldVisitor& visitor);

/// The larger of the two widths at a range, metres.
double diameter_m(const Footprint& footprint, double range_m);

/// One sub-ray: its offset and slope across the beam, and its share of the energy.
struct SubRay {
  Eigen::Vector2d offset_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  double share = 1.0;
  double shortening = 1.0;  ///< 1 / sqrt(1 + slope^2), normalises the sub-ray's direction
};

/// The central ray and its rings. The disc and the rings up to the 1/e^2 radius w (one ring: up to
/// w/2), and the last ring beyond it, have the energy of the Gaussian between their radii a and b,
/// exp(-2 a^2/w^2) - exp(-2 b^2/w^2) (as in HELIOS++, src/model/ImprovedEnergyModel.cpp; Winiwarter
/// et al., Remote Sens. Environ. 269 (2022) 112772). Rays are at the rms radius of their ring,
/// scaled so that the second moment of the beam is exact. Offsets and slopes differ by a quarter
/// turn: the rays of a ring form a hyperboloid with the width of the Gaussian beam at every range.
std::vector<SubRay> sample_footprint(const Footprint& footprint);

/// The sub-rays of a range of beams as beams of one row: those of the first beam, the next, ...
void expand_beams(const std::vector<SubRay>& rays, const Beams& beams, BeamRange range,
                  ThreadPool& thread_pool, Beams& out);

}  // namespace glidar
