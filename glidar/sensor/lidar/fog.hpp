// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/elementary.hpp>
#include <glidar/sensor/lidar/lidar_equation.hpp>

#include <vector>

namespace glidar {

/// The echo of fog in front of a hard target: its range and signal S.
struct SoftEcho {
  double range_m = 0.0;
  double signal = 0.0;
};

/// Integrals over fog near the sensor as functions of the fog's end.
struct FogProfile {
  double start_m = 0.0;  ///< the receiver sees no nearer fog
  double step_m = 0.0;
  double turns_per_m = 0.0;  ///< 1 / (c FWHM)
  struct Sums {
    double plain = 0.0;
    double cosine = 0.0;
    double sine = 0.0;
  };
  std::vector<Sums> up_to =
      {};  ///< integrals of w, w cos(k r), w sin(k r) from start_m to start_m + i step_m
};

/// The echo of fog as a function of the range of the hard target behind it, from start_m in equal
/// steps; constant beyond the last.
struct FogReturn {
  double start_m = 0.0;
  double step_m = 0.0;
  std::vector<SoftEcho> by_hard_range = {};  ///< empty: no fog
};

/// A layer dr of fog returns the signal of a surface with the reflectance pi backscatter dr:
/// w(r) = weather_signal(pi backscatter, r).
FogProfile fog_profile(const LidarEquation& light, double backscatter_per_m_sr,
                       double pulse_fwhm_s);

/// The same up to `end_m` instead of the end of the echo of uniform fog.
FogProfile fog_profile(const LidarEquation& light, double backscatter_per_m_sr, double pulse_fwhm_s,
                       double end_m);

/// c FWHM, the length of the whole pulse in range, metres.
double pulse_length_m(double pulse_fwhm_s);

/// The integrals up to a range, interpolated.
FogProfile::Sums sums_to(const FogProfile& profile, double range_m);

/// The integral of w(r) sin^2 of the difference of two angles, from the integrals and the angle of
/// the time.
double pulse_of(const FogProfile::Sums& part, const SineCosine& angle);

/// S at the time c t / 2 = range_m after the start of a pulse sin^2(pi t / (2 FWHM)),
/// 0 <= t <= 2 FWHM: the integral of w(r) sin^2(pi (range - r) / (c FWHM)) dr over the fog in front
/// of the target (Rasshofer et al. 2011; Hahner et al. 2021).
double fog_signal(const FogProfile& profile, double range_m, double hard_range_m);

/// The maximum of fog_signal(). Its range refers to the middle of the pulse, as for hard targets:
/// c FWHM / 2 less than from the start of the pulse.
FogReturn fog_return(const LidarEquation& light, double backscatter_per_m_sr, double pulse_fwhm_s);

/// The echo in front of a hard target, or of unbounded fog for an infinite range.
SoftEcho echo_before(const FogReturn& fog, double hard_range_m);

}  // namespace glidar
