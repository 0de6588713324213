// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/elementary.hpp>
#include <glidar/sensor/lidar/lidar_equation.hpp>

#include <vector>

namespace glidar {

/// The echo of fog up to a hard target, as its range and signal S.
struct SoftEcho {
  double range_m = 0.0;
  double signal = 0.0;
};

/// Sums over fog near the sensor, by the end of the fog.
struct FogProfile {
  double start_m = 0.0;  ///< the receiver sees no fog before
  double step_m = 0.0;
  double turns_per_m = 0.0;  ///< 1 / (c FWHM)
  struct Sums {
    double plain = 0.0;
    double cosine = 0.0;
    double sine = 0.0;
  };
  std::vector<Sums> up_to =
      {};  ///< the integrals of w, w cos(k r), w sin(k r) to start_m + i step_m
};

/// Fog's echo by the range of the hard target behind it, from start_m in equal steps; the same for
/// all targets beyond.
struct FogReturn {
  double start_m = 0.0;
  double step_m = 0.0;
  std::vector<SoftEcho> by_hard_range = {};  ///< empty: no fog
};

/// A layer dr of fog sends back as a surface of reflectance pi backscatter dr does, at the time of
/// its range: w(r) = air_signal(pi backscatter, r).
FogProfile fog_profile(const LidarEquation& light, double backscatter_per_m_sr,
                       double pulse_fwhm_s);

/// The same up to another range than where the echo of even fog ends.
FogProfile fog_profile(const LidarEquation& light, double backscatter_per_m_sr, double pulse_fwhm_s,
                       double end_m);

/// c FWHM, from begin to end of the pulse in range.
double pulse_length_m(double pulse_fwhm_s);

/// The integrals up to any range.
FogProfile::Sums sums_to(const FogProfile& profile, double range_m);

/// The integral of w(r) sin^2 of the difference of two angles, from those of w and the angle of the
/// time.
double pulse_of(const FogProfile::Sums& part, const SineCosine& angle);

/// S at the time c t / 2 = range_m since a pulse sin^2(pi t / (2 FWHM)), 0 <= t <= 2 FWHM, began:
/// the integral of w(r) sin^2(pi (range - r) / (c FWHM)) dr over the fog before the target
/// (Rasshofer et al. 2011; Hahner et al. 2021).
double fog_signal(const FogProfile& profile, double range_m, double hard_range_m);

/// Where that is largest. Its range counts from the pulse's middle, as those of hard targets do:
/// c FWHM / 2 less than since the pulse's begin.
FogReturn fog_return(const LidarEquation& light, double backscatter_per_m_sr, double pulse_fwhm_s);

/// The echo before a hard target, or that of fog without end for an infinite range.
SoftEcho echo_before(const FogReturn& fog, double hard_range_m);

}  // namespace glidar
