// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/noise/noise.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// A random number that a noise step uses for an entry of a frame.
struct RandomSample {
  enum class Distribution : std::uint8_t {
    normal,
    uniform
  };  ///< standard normal; uniform in (0, 1)
  Distribution distribution = Distribution::normal;
  double value = 0.0;
  std::string use;                         ///< its use in the step
  std::optional<double> probability = {};  ///< the probability that it is compared with, if any
};

/// The random numbers that step `place` of a list uses for an entry, with the same keys as the step
/// itself. `beams` are the nominal beams, the frame is as before the step, frame_s is the frame
/// period in seconds.
std::vector<RandomSample> trace_samples(const std::vector<NoiseStep>& noise, std::size_t place,
                                        const Beams& beams, const Frame& frame, double frame_s,
                                        std::size_t entry);

}  // namespace glidar
