// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/elementary.hpp>
#include <glidar/math/random.hpp>
#include <glidar/sensor/lidar/fog.hpp>

#include <array>
#include <vector>

namespace glidar {

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
