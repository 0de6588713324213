// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/function_ref.hpp>
#include <glidar/math/random.hpp>
#include <glidar/sensor/lidar/drop_size_distribution.hpp>
#include <glidar/sensor/lidar/lidar_equation.hpp>

#include <vector>

namespace glidar {

/// A beam that is evenly bright over the diameter exit_diameter_m + divergence_rad R.
struct BeamShape {
  double divergence_rad = 0.003;  ///< full angle
  double exit_diameter_m = 0.0;
};

double beam_diameter_m(const BeamShape& beam, double range_m);

/// The beam's volume up to a range: of a cone without its tip.
double beam_volume_m3(const BeamShape& beam, double range_m);

/// A stretch of the beam, up to where the next begins.
struct DropShell {
  double from_m = 0.0;
  double volume_before_m3 = 0.0;  ///< beam_volume_m3(from_m)
  double mean_before = 0.0;       ///< of the number of drops in all shells before
  double drops_per_m3 = 0.0;      ///< of least_diameter_m and larger
  double least_diameter_m = 0.0;  ///< no smaller drop in this shell can reach the least signal
};

/// The drops of a beam that may be seen. Drops are a Poisson process over range and diameter; those
/// above a bound that depends on the range are one too, so that those too faint to matter need not
/// be drawn, and drops drawn in vain below the exact bound may be thrown away (thinning: Lewis and
/// Shedler, Nav. Res. Logist. Q. 26 (1979) 403).
struct DropField {
  DropSizes sizes;
  BeamShape beam;
  double min_signal = 0.0;
  std::vector<DropShell> shells = {};  ///< of the last the density is 0; empty: no drops
};

struct DropEcho {
  double range_m = 0.0;
  double signal = 0.0;
  double diameter_m = 0.0;
};

/// S of a drop: it sends back sizes.reflectance by its share of the beam's cross-section, at most
/// all of it (Kilic et al., arXiv:2107.07004).
double drop_signal(const LidarEquation& light, const DropField& field, double range_m,
                   double diameter_m);

DropField drop_field(const LidarEquation& light, const DropSizes& sizes, const BeamShape& beam,
                     double min_signal);

/// Gives the drops up to a hard target, the nearest first. They are those of `draw`, from its block
/// on, whatever the target's range.
void draw_drops(const LidarEquation& light, const DropField& field, double hard_range_m,
                RngKey draw, FunctionRef<void(const DropEcho&)> take);

}  // namespace glidar
