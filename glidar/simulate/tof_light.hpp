// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/simulation.hpp>

#include <cstddef>

namespace glidar {

/// Consecutive phase steps of a time-of-flight camera that see the scene at the same time.
struct TofExposure {
  std::size_t first = 0;
  std::size_t end = 0;
  std::uint32_t time_ns = 0;  ///< since the start of the frame
};

/// Adds light that returns from a range to the steps of an exposure; `of_steps` are all of a pixel.
void add_light(const TofSteps& steps, const TofExposure& exposure, const TofLight& light,
               double range_m, std::span<TofLight> of_steps);

/// The light of each pixel in each phase step, in Simulation::workspace: that of the illuminator,
/// which is at the camera, directly and over diffuse bounces, and the background. The signal of a
/// surface is A backscatter / R^2, the mean over the rays of the pixel. Where something moves, each
/// step sees the scene at its own time.
void find_tof_light(const Simulation& s, const PreparedTof& prepared);

}  // namespace glidar
