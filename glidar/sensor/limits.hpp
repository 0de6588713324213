// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>

namespace glidar {

class FieldVisitor;
class ThreadPool;

/// The distances that the sensor reports. A surface outside them still blocks the beam. They are
/// applied twice: to surfaces, and to what noise makes of their distances.
struct Limits {
  enum class Along : std::uint8_t { depth, range };
  double near_m = 0.0;  ///< 0: no limit, so depths below 0 (views wider than 180 degrees) count too
  double far_m = std::numeric_limits<double>::infinity();
  Along along = Along::depth;  ///< the limits apply to depth (boresight) or range (beam)
};

/// Keys of `limits` in sensor files.
void describe(Limits& limits, FieldVisitor& visitor);

/// The status of a surface at this range on a beam: hit, too_near or too_far.
Status check_limits(const Limits& limits, const Beams& beams, std::size_t beam, double range_m);

/// Ranges and statuses of a tile of beams from the ranges of the ground truth.
void classify_surfaces(const Limits& limits, const Beams& beams, BeamRange tile, Frame& frame);

/// Removes the returns whose measured distance is outside the limits. `beams` are the nominal
/// beams, without pointing noise, along which the sensor reports.
void remove_returns_outside(const Limits& limits, const Beams& beams, ThreadPool& thread_pool,
                            Frame& frame);

/// A measured depth or range within the limits in whole units of an output: the nearest number, or
/// its neighbour where the nearest is outside the limits.
double to_whole_units(const Limits& limits, Limits::Along along, double distance_m, double unit_m);

}  // namespace glidar
