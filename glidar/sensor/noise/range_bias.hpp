// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>
#include <glidar/math/random.hpp>

namespace glidar {

class FieldVisitor;
struct NoiseBatch;
struct NoiseView;

// Errors of the sensor itself: surfaces do not scale them, and Frame::sigma_m does not include
// them.

/// A constant range error: one offset for all rings, and a normal error per ring that is constant
/// over all frames.
struct RangeBias {
  static constexpr TypeInfo kType = {"range_bias",
                                     "an offset, and a constant normal error of each ring",
                                     "gz-sensors, GaussianNoiseModel: a bias drawn once"};
  double offset_m = 0.0;
  double sigma_m = 0.0;
};

/// Drift of the range, a stationary Gauss-Markov process over the frames: standard deviation sigma,
/// correlation exp(-dt / tau).
struct RangeDrift {
  static constexpr TypeInfo kType = {
      "range_drift", "stationary Gauss-Markov process over the frames, correlation exp(-Δt/τ)",
      "gz-sensors, GaussianNoiseModel"};
  double sigma_m = 0.0;
  double tau_s = 1.0;
  bool per_ring = false;  ///< an independent process per ring
};

/// The process with standard deviation 1 at a frame, computed without the frames before it.
/// Frames 0, M, 2M ... have independent values, where M = 2^L is so large that the correlation is
/// below 1e-6. Between two known frames, the frame in the middle, h away from each, is sampled from
/// its conditional distribution with mean (a + b) p / (1 + p^2) and variance (1 - p^2) /
/// (1 + p^2), p = exp(-h dt / tau), and so on down to the requested frame. The normal number of a
/// frame has key.frame = the frame, so that it is the same for every requested frame.
double drift_at(std::uint32_t frame, double frames_per_tau, RngKey key);

/// Keys in sensor files.
void describe(RangeBias& step, FieldVisitor& visitor);
void describe(RangeDrift& step, FieldVisitor& visitor);

void apply(const RangeBias& step, const NoiseView& view, NoiseBatch& batch);
void apply(const RangeDrift& step, const NoiseView& view, NoiseBatch& batch);

}  // namespace glidar
