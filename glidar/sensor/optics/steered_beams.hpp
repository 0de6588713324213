// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/sensor/optics: what scanners with rotating glass have in common.

#include <glidar/core/beams.hpp>
#include <glidar/sensor/optics/firing_schedule.hpp>

#include <cstdint>
#include <functional>
#include <span>

namespace glidar {

/// Snell's law for vectors: the unit direction behind a face whose unit normal is opposed to the
/// light; `ratio` is the refractive index before over that behind. NaN for total reflection.
Eigen::Vector3d refract(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal,
                        double ratio);

/// The phase at firing k, in turns, of what rotates `turns_per_firing` turns from one firing to the
/// next. Whole turns are left out, so that phases stay exact after many turns.
double phase_turns(double at_zero_turns, double turns_per_firing, std::int64_t k);

/// Writes the unit directions of all rows at firing k.
using FiringDirections = std::function<void(std::int64_t k, std::span<Eigen::Vector3d> directions)>;

/// Beams that fire together at every event of the schedule: rows = rings = beams, cols = firings in
/// the interval in time order. Frame lidar_frame (x forward, y left, z up), boresight +x.
Beams make_steered_beams(const FiringSchedule& pulses, const FrameInterval& interval,
                         std::size_t rows, const FiringDirections& directions_at);

}  // namespace glidar
