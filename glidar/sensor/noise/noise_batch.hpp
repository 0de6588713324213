// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/math/distributions.hpp>
#include <glidar/sensor/noise/noise_trace.hpp>
#include <glidar/sensor/noise/noise_workspace.hpp>

#include <initializer_list>

namespace glidar {

/// Records the random numbers of one entry of a frame.
struct SampleRecorder {
  std::size_t entry = 0;
  std::vector<std::vector<RandomSample>> steps;  ///< one for each noise step
};

/// The random numbers of a noise step for a batch of beams. If `recorded` is set, it receives those
/// of the traced beam with their use in the step.
struct Sampler {
  RngKey key;  ///< of the first beam
  std::vector<RandomSample>* recorded = nullptr;
  std::size_t traced = 0;  ///< from the first beam; kSampleBatch or more: in another batch
};

/// The same sampler for the batch that begins `offset` beams later.
inline Sampler later_batch(Sampler sampler, std::size_t offset) {
  sampler.key.beam += static_cast<std::uint32_t>(offset);
  sampler.traced -= offset;  // wraps around if the beam is in an earlier batch
  return sampler;
}

/// The same sampler with another block of words.
inline Sampler block(Sampler sampler, std::uint32_t number) {
  sampler.key.block = number;
  return sampler;
}

/// Records make(i), where i is the traced beam, if the batch contains it.
template <class Make>
void record(const Sampler& sampler, const Make& make) {
  if (sampler.recorded == nullptr || sampler.traced >= kSampleBatch) return;
  sampler.recorded->push_back(make(sampler.traced));
}

inline void record_normal(const Sampler& sampler, const char* use, const Batch<double>& normals) {
  record(sampler, [&](std::size_t i) { return RandomSample{.value = normals[i], .use = use}; });
}

inline void record_uniform(const Sampler& sampler, const char* use, const Batch<double>& uniforms) {
  record(sampler, [&](std::size_t i) {
    return RandomSample{RandomSample::Distribution::uniform, uniforms[i], use};
  });
}

// The functions of math/distributions.hpp, which record the number of the traced beam.

inline void sample_shared_normals(const Sampler& sampler, const char* use, Batch<double>& normals) {
  sample_shared_normals(sampler.key, normals);
  record_normal(sampler, use, normals);
}

inline void sample_shared_uniforms(const Sampler& sampler, const char* use,
                                   Batch<double>& uniforms) {
  sample_shared_uniforms(sampler.key, uniforms);
  record_uniform(sampler, use, uniforms);
}

inline void sample_normals(const Sampler& sampler, const char* first_use, const char* second_use,
                           PairBatch& normals) {
  sample_normals(sampler.key, normals);
  record_normal(sampler, first_use, normals.first);
  record_normal(sampler, second_use, normals.second);
}

/// The use of a random number, and the probability that it is compared with, if any.
struct SampleUse {
  const char* use;
  std::optional<double> probability = {};
};

/// Words that a step uses as uniform numbers: word k for uses[k].
inline void sample_words(const Sampler& sampler, std::initializer_list<SampleUse> uses,
                         WordBatch& words) {
  sample_words(sampler.key, words);
  for (std::size_t k = 0; k < uses.size(); ++k) {
    const SampleUse& use = uses.begin()[k];
    record(sampler, [&](std::size_t i) {
      return RandomSample{RandomSample::Distribution::uniform, uniform(words.word.at(k)[i]),
                          use.use, use.probability};
    });
  }
}

/// kSampleBatch consecutive beams of a frame, small enough for the processor's cache, to which the
/// noise steps are applied one after the other. Beams beyond the last, and beams without a return,
/// have the range NaN, so that arithmetic needs no conditions.
struct alignas(64) NoiseBatch {
  Batch<double> range_m;      ///< from the beam's origin, without Beams::range_offset_m
  Batch<double> variance_m2;  ///< variance of the range error, summed over the steps so far
  Batch<double> intensity;
  Batch<double> scale;          ///< factor of the surface on standard deviations
  Batch<double> cosine;         ///< of the incidence angle; 1 unless a step requires it
  Batch<double> depth_per_m;    ///< depth = depth_at_zero + depth_per_m * range; these two are
  Batch<double> depth_at_zero;  ///< 1 and 0 unless a step requires depth
  Batch<Status> status;
  std::size_t first = 0;  ///< index of the first beam
  std::size_t count = 0;  ///< number of beams
  Sampler sampler;        ///< the step's random numbers
  double frame_s = 0.0;   ///< frame period
};

/// The frame and the beams of a batch, as a noise step sees them.
struct NoiseView {
  const Beams& beams;
  Frame& frame;  ///< columns of other batches must not be accessed
  NoiseWorkspace& workspace;
};

/// Removes the return of a beam of the batch.
inline void invalidate_return(NoiseBatch& batch, std::size_t i, Status why) {
  batch.range_m[i] = std::numeric_limits<double>::quiet_NaN();
  batch.intensity[i] = 0.0;
  batch.status[i] = why;
}

/// Sets the source of a return of the batch that is not an echo of the beam's own light.
inline void set_return_source(const NoiseView& view, const NoiseBatch& batch, std::size_t i,
                              ReturnSource source) {
  view.frame.return_source[batch.first + i] = source;
}

inline bool is_hit(const NoiseBatch& batch, std::size_t i) {
  return batch.status[i] == Status::hit;
}

}  // namespace glidar
