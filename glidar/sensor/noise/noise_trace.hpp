// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

struct Beams;
struct Frame;
struct NoisePlan;
class ThreadPool;

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

/// The random numbers of an entry, one list for each noise step, recorded while the steps are
/// applied to a copy of the frame as it was before noise. `beams` are the nominal beams.
std::vector<std::vector<RandomSample>> trace_samples(NoisePlan noise, const Beams& beams,
                                                     ThreadPool& thread_pool, Frame frame,
                                                     std::size_t entry);

}  // namespace glidar
