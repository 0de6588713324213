// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/elementary.hpp>
#include <glidar/math/random.hpp>
#include <glidar/sensor/lidar/fog.hpp>

#include <array>
#include <vector>

namespace glidar {

/// Fog whose backscatter varies along each beam. Cells as long as a pulse reaches at once,
/// c FWHM / 2, with a random place of the first border have independent factors of mean 1. They are
/// gamma distributed, as the intensity of speckle averaged over `looks` (Goodman, "Speckle
/// Phenomena in Optics", 2nd ed. 2020, section 3.3) and as laser light scattered by fog, drizzle
/// and snow is measured to be (Vostretsov, Atmos. Ocean. Opt. 31 (2018) no. 1; Vostretsov and
/// Zhukov, ibid. 8 (1995) no. 12). Extinction stays that of the mean.
struct VaryingFog {
  static constexpr std::size_t kNodesPerPulse = 16;

  unsigned looks = 0;
  double cell_m = 0.0;
  double end_m = 0.0;  ///< farther fog sends back less than 1/200 of what the brightest does
  FogProfile profile = {};
  std::vector<FogProfile::Sums> nodes =
      {};  ///< of the profile, 16 per length of a pulse; empty: none
  std::array<SineCosine, kNodesPerPulse> angles = {};  ///< at the nodes; they repeat
};

/// `looks` from 1 on.
VaryingFog varying_fog(const LidarEquation& light, double backscatter_per_m_sr, double pulse_fwhm_s,
                       unsigned looks);

/// Fog of constant backscatter.
struct FogCell {
  double from_m = 0.0;
  double factor = 1.0;  ///< of the mean backscatter
};

/// The cells of a beam up to a range, in order. A function of seed, sensor, frame and beam alone:
/// a farther range appends cells.
void draw_fog_cells(const VaryingFog& fog, double end_m, RngKey draw, std::vector<FogCell>& cells);

/// The largest echo of the fog before a hard target, or of fog without end for an infinite range.
SoftEcho echo_before(const VaryingFog& fog, double hard_range_m, const RngKey& draw);

}  // namespace glidar
