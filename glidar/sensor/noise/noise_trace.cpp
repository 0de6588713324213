// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/noise/noise_trace.hpp>

#include <glidar/sensor/noise/noise.hpp>
#include <glidar/sensor/noise/noise_batch.hpp>

namespace glidar {

std::vector<std::vector<RandomSample>> trace_samples(NoisePlan noise, const Beams& beams,
                                                     ThreadPool& thread_pool, Frame frame,
                                                     std::size_t entry) {
  SampleRecorder recorder{entry, std::vector<std::vector<RandomSample>>(noise.steps.size())};
  noise.recorder = &recorder;
  Beams perturbed;
  NoiseWorkspace workspace;
  perturb_directions(noise, beams, frame, thread_pool, perturbed);
  apply_noise(noise, beams, thread_pool, workspace, frame);
  return recorder.steps;
}

}  // namespace glidar
