// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/math/thread_pool.hpp>

#include <vector>

namespace glidar {

/// The cross-section of a beam: a Gaussian, told by its full widths where the irradiance is 1/e^2
/// of the middle's. It is x sqrt(exit^2 + (divergence R)^2) wide at range R; x lies across, y
/// upwards in the sensor's frame.
struct Footprint {
  double divergence_x_rad = 0.0;
  double divergence_y_rad = 0.0;
  double exit_x_m = 0.0;
  double exit_y_m = 0.0;
  unsigned rings = 2;  ///< of sub-rays around the middle one: 6, 12, 18, ... rays
};

inline constexpr unsigned kMaxRings = 8;

/// Full width at 1/e^2 of a Gaussian beam over its full width at half maximum: sqrt(2 / ln 2).
inline constexpr double kWidthPerFwhm = 1.6986436005760381;

/// Throws Error naming the number that is out of range.
void validate(const Footprint& footprint);

/// The wider diameter at a range.
double diameter_m(const Footprint& footprint, double range_m);

/// One sub-ray: it starts at `offset` and leans by `slope`, both across the beam, and carries a
/// share of its energy.
struct SubRay {
  Eigen::Vector2d offset_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  double share = 1.0;
  double shortening =
      1.0;  ///< 1 / sqrt(1 + slope^2): makes a beam's direction, leaning, a unit vector
};

/// The middle ray and its rings. A disc around the middle and the rings around it, out to the
/// 1/e^2 radius w (one ring: to w/2) and the last beyond, carry what a Gaussian has there,
/// exp(-2 a^2/w^2) - exp(-2 b^2/w^2) between radii a and b (as HELIOS++ has it in
/// src/model/ImprovedEnergyModel.cpp; Winiwarter et al., Remote Sens. Environ. 269 (2022) 112772).
/// Rays stand at their ring's rms radius, scaled so that the beam's second moment is exact. Offsets
/// and slopes are a quarter turn apart: the rays of a ring lie on a hyperboloid, as wide at every
/// range as the Gaussian beam is.
std::vector<SubRay> sample_footprint(const Footprint& footprint);

/// The sub-rays of a run of beams as beams of one row: those of the first beam, of the next, ...
void expand_beams(const std::vector<SubRay>& rays, const Beams& beams, BeamRange range,
                  ThreadPool& thread_pool, Beams& out);

}  // namespace glidar
