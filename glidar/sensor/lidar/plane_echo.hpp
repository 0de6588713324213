// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/lidar/footprint.hpp>

#include <Eigen/Core>
#include <span>

namespace glidar {

/// A plane across a beam, as its central ray meets it.
struct PlaneAcrossBeam {
  double range_m = 0.0;
  /// By how much the range grows per metre sideways and upwards; its norm is the tangent of the
  /// angle of incidence.
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();
};

/// The plane with this normal, towards the sensor, across a beam of a sensor with this upward
/// direction (SensorAxes).
PlaneAcrossBeam plane_across(const Eigen::Vector3d& direction, const Eigen::Vector3d& up,
                             double range_m, const Eigen::Vector3d& normal);

inline constexpr std::size_t kMaxSubRays = 1 + 3 * kMaxRings * (kMaxRings + 1);

/// What a whole beam receives from a plane.
struct PlaneEcho {
  double signal = 1.0;       ///< sum; of what the central ray would with all of the energy
  double range_m = 0.0;      ///< mean, weighted by signal
  double variance_m2 = 0.0;  ///< of the ranges, weighted by signal
};

/// True where the series of integrate_over_plane() are more accurate than seven sub-rays, and the
/// ranges differ by so little that the echo of a pulse with this standard deviation has one peak.
bool has_closed_form(const Footprint& footprint, const PlaneAcrossBeam& plane,
                     double pulse_sigma_m);

/// Integrates the Gaussian profile over a diffuse plane, with a signal that is proportional to
/// cos(incidence) / R^exponent, up to the fourth order of the beam's width: the derivation is in
/// docs/internals/echoes.md. The variance is that of Gardner, "Target signatures for laser
/// altimeters: an analysis", Appl. Opt. 21 (1982) 448, and IEEE TGRS 30 (1992) 1061, in second
/// order. `excess`, per sub-ray, is by how much its reflectance exceeds that of the central ray, in
/// units of it; empty: nowhere.
PlaneEcho integrate_over_plane(const Footprint& footprint, const PlaneAcrossBeam& plane,
                               double exponent, std::span<const SubRay> rays,
                               std::span<const double> excess);

}  // namespace glidar
