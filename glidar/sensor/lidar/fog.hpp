// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/elementary.hpp>
#include <glidar/math/random.hpp>
#include <glidar/sensor/lidar/lidar_equation.hpp>

#include <array>
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

/// Fog whose backscatter varies along each beam. Cells of the length c FWHM / 2, the extent of a
/// pulse, with a random position of the first border have independent factors of mean 1. They are
/// gamma distributed, like the intensity of speckle averaged over `looks` (Goodman, "Speckle
/// Phenomena in Optics", 2nd ed. 2020, section 3.3) and like measurements of laser light scattered
/// by fog, drizzle and snow (Vostretsov, Atmos. Ocean. Opt. 31 (2018) no. 1; Vostretsov and Zhukov,
/// ibid. 8 (1995) no. 12). Extinction is that of the mean.
struct VaryingFog {
  static constexpr std::size_t kNodesPerPulse = 16;

  unsigned looks = 0;
  double cell_m = 0.0;
  double end_m = 0.0;  ///< farther fog returns less than 1/200 of the maximum
  FogProfile profile = {};
  std::vector<FogProfile::Sums> nodes =
      {};  ///< nodes of the profile, kNodesPerPulse per pulse length; empty: no fog
  std::array<SineCosine, kNodesPerPulse> angles = {};  ///< angles at the nodes, periodic
};

/// `looks` is at least 1.
VaryingFog varying_fog(const LidarEquation& light, double backscatter_per_m_sr, double pulse_fwhm_s,
                       unsigned looks);

/// A cell of constant backscatter.
struct FogCell {
  double from_m = 0.0;
  double factor = 1.0;  ///< of the mean backscatter
};

/// The cells of a beam up to a range, in order. They depend on seed, sensor, frame and beam only:
/// a larger range appends cells.
void sample_fog_cells(const VaryingFog& fog, double end_m, RngKey key, std::vector<FogCell>& cells);

/// The largest echo of the fog in front of a hard target, or of unbounded fog for an infinite
/// range.
SoftEcho echo_before(const VaryingFog& fog, double hard_range_m, const RngKey& key);

}  // namespace glidar
