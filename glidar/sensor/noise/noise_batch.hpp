// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/math/distributions.hpp>
#include <glidar/sensor/noise/noise_workspace.hpp>
#include <glidar/sensor/noise/sampler.hpp>

namespace glidar {

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
