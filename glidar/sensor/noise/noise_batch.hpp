// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/math/gaussian.hpp>

namespace glidar {

/// A run of kDrawBatch beams of a frame, in the processor's cache: one step of noise after the
/// other works on it. Beams after the last, and beams without a hit, have a range of NaN, so that
/// arithmetic needs no conditions.
struct alignas(64) NoiseBatch {
  Batch<double> range_m;
  Batch<double> variance_m2;  ///< of the range's random error, the sum of the steps so far
  Batch<double> intensity;
  Batch<double> scale;          ///< what the surface multiplies standard deviations by
  Batch<double> cosine;         ///< of the incidence; 1 unless a step asked for it
  Batch<double> depth_per_m;    ///< depth = depth_at_zero_m + depth_per_m * range; these two are
  Batch<double> depth_at_zero;  ///< 1 and 0 unless a step asked for depth
  Batch<Status> status;
  std::size_t first = 0;  ///< index of the run's first beam
  std::size_t count = 0;  ///< beams in the run
  RngKey draw;            ///< identity of the step's random numbers for the run's first beam
  double frame_s = 0.0;   ///< from one frame to the next
};

/// A frame and its beams as a step of noise sees them from outside its run.
struct NoiseView {
  const Beams& beams;
  Frame& frame;  ///< columns of other beams must be neither read nor written, but for the scratch
};

/// The sensor loses the return of a beam of the run.
inline void invalidate_return(NoiseBatch& batch, std::size_t i, Status why) {
  batch.range_m[i] = std::numeric_limits<double>::quiet_NaN();
  batch.intensity[i] = 0.0;
  batch.status[i] = why;
}

/// A return of the run is not what the beam's own light brought back.
inline void set_cause(const NoiseView& view, const NoiseBatch& batch, std::size_t i,
                      ReturnSource cause) {
  view.frame.return_source[batch.first + i] = cause;
}

inline bool is_hit(const NoiseBatch& batch, std::size_t i) {
  return batch.status[i] == Status::hit;
}

/// The same draw for another block of words.
inline RngKey block(RngKey draw, std::uint32_t number) {
  draw.block = number;
  return draw;
}

}  // namespace glidar
