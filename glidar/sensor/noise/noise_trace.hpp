// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/noise/noise.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// A random number that a step of noise takes for an entry of a frame.
struct RandomSample {
  enum class Law : std::uint8_t { normal, uniform };  ///< of mean 0 and deviation 1; from 0 to 1
  Law law = Law::normal;
  double value = 0.0;
  std::string use;                     ///< what the step does with it
  std::optional<double> against = {};  ///< of a chance: the probability that it is held against
};

/// The random numbers that step `place` of a list takes for an entry, by the same draws as the step
/// itself. `beams` are those that the sensor reports, the frame is as the step finds it, frame_s is
/// the time between frames.
std::vector<RandomSample> trace_samples(const std::vector<NoiseStep>& noise, std::size_t place,
                                        const Beams& beams, const Frame& frame, double frame_s,
                                        std::size_t entry);

}  // namespace glidar
