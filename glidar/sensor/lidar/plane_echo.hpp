// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/lidar/footprint.hpp>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

namespace glidar {

inline constexpr std::size_t kMaxSubRays = 1 + 3 * kMaxRings * (kMaxRings + 1);

/// Planes across beams, as their central rays meet them, and what whole beams receive from them.
/// One number per beam.
struct PlaneBatch {
  static constexpr std::size_t kMax = 64;
  using Column = std::array<double, kMax>;
  struct Columns3 {
    Column x;
    Column y;
    Column z;

    void set(std::size_t i, const Eigen::Vector3d& v) {
      x[i] = v.x();
      y[i] = v.y();
      z[i] = v.z();
    }
  };
  std::size_t count = 0;
  // Set by the caller:
  Columns3 direction;
  Columns3 normal;  ///< towards the sensor
  Column range_m;   ///< of the central ray
  // Set by find_tilts(): by how much the range grows per metre sideways and upwards. The norm is
  // the tangent of the angle of incidence.
  Column tilt_x;
  Column tilt_y;
  // Set by integrate_over_planes():
  /// Sums of signal R^k, k = 0, 1, 2, in units of what the central ray would have with all of the
  /// energy.
  std::array<Column, 3> moment;
  /// Whether the series are more accurate than seven sub-rays, and the ranges differ by so little
  /// that the echo of the pulse has one peak.
  std::array<bool, kMax> has_closed_form;
};

/// Finds the tilts of planes across the beams of a sensor with this upward direction (SensorAxes).
void find_tilts(const Eigen::Vector3d& up, PlaneBatch& planes);

/// What integrate_over_planes() needs to know of a sensor.
struct PlanePulse {
  const Footprint& footprint;
  double exponent = 2.0;       ///< the signal is proportional to cos(incidence) / R^exponent
  double pulse_sigma_m = 0.0;  ///< standard deviation of the pulse
};

/// Integrates the Gaussian profile over diffuse planes up to the fourth order of the beam's width:
/// the derivation is in docs/internals/echoes.md. The variance is that of Gardner, "Target
/// signatures for laser altimeters: an analysis", Appl. Opt. 21 (1982) 448, and IEEE TGRS 30 (1992)
/// 1061, in second order.
void integrate_over_planes(const PlanePulse& pulse, PlaneBatch& planes);

/// What a beam receives from a plane, see PlaneBatch.
struct PlaneMoments {
  double range_m = 0.0;
  double tilt_x = 0.0;
  double tilt_y = 0.0;
  std::array<double, 3> moment = {1.0, 1.0, 1.0};
};

PlaneMoments moments_of(const PlaneBatch& planes, std::size_t i);
void set_moments(const PlaneMoments& moments, std::size_t i, PlaneBatch& planes);

/// Changes the reflectances at the sub-rays. `excess`, per sub-ray and plane, is by how much one
/// exceeds that of the central ray, in units of it.
void add_excess(double exponent, std::span<const SubRay> rays,
                std::span<const PlaneBatch::Column> excess, PlaneBatch& planes);

/// Echoes of whole beams, one number per plane.
struct PlaneEchoes {
  PlaneBatch::Column range_m;  ///< mean, weighted by signal
  PlaneBatch::Column signal;   ///< sum
  PlaneBatch::Column peak;     ///< height of the widened pulse
  PlaneBatch::Column sigma_m;  ///< of the widened pulse
};

/// Finds echoes from the moments; `signal` of central rays that have all of the energy.
void find_echoes(double pulse_sigma_m, const PlaneBatch::Column& signal, const PlaneBatch& planes,
                 PlaneEchoes& echoes);

}  // namespace glidar
