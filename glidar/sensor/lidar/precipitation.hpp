// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/function_ref.hpp>
#include <glidar/math/random.hpp>
#include <glidar/sensor/lidar/drop_size_distribution.hpp>
#include <glidar/sensor/lidar/lidar_equation.hpp>

#include <vector>

namespace glidar {

/// A beam of uniform irradiance with the diameter exit_diameter_m + divergence_rad R.
struct BeamShape {
  double divergence_rad = 0.003;  ///< full angle
  double exit_diameter_m = 0.0;
};

double beam_diameter_m(const BeamShape& beam, double range_m);

/// The beam's volume up to a range: a truncated cone.
double beam_volume_m3(const BeamShape& beam, double range_m);

/// A section of the beam, which ends where the next one begins.
struct DropShell {
  double from_m = 0.0;
  double volume_before_m3 = 0.0;  ///< beam_volume_m3(from_m)
  double mean_before = 0.0;       ///< mean number of drops in all shells before
  double drops_per_m3 = 0.0;      ///< of min_diameter_m and larger
  double min_diameter_m = 0.0;    ///< no smaller drop in this shell can reach the minimum signal
};

/// The detectable drops of a beam. Drops are a Poisson process over range and diameter. So are
/// those above a bound that depends on the range; therefore fainter drops need not be sampled, and
/// samples below the exact bound are rejected (thinning: Lewis and Shedler, Nav. Res. Logist. Q. 26
/// (1979) 403).
struct DropField {
  DropSizes sizes;
  BeamShape beam;
  double min_signal = 0.0;
  std::vector<DropShell> shells = {};  ///< the last has density 0; empty: no drops
};

struct DropEcho {
  double range_m = 0.0;
  double signal = 0.0;
  double diameter_m = 0.0;
};

/// S of a drop: its backscatter is sizes.reflectance times its share of the beam's cross-section,
/// at most 1 (Kilic et al., arXiv:2107.07004).
double drop_signal(const LidarEquation& light, const DropField& field, double range_m,
                   double diameter_m);

DropField drop_field(const LidarEquation& light, const DropSizes& sizes, const BeamShape& beam,
                     double min_signal);

/// Samples the drops in front of a hard target, the nearest first. They depend on `key` only,
/// whose blocks are used from key.block on, not on the range of the target.
void sample_drops(const LidarEquation& light, const DropField& field, double hard_range_m,
                  RngKey key, FunctionRef<void(const DropEcho&)> take);

}  // namespace glidar
