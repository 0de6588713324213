// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/random.hpp>

namespace glidar {

struct NoiseBatch;
struct NoiseView;

// These errors are the sensor's own: a surface does not scale them, and they are no part of
// Frame::sigma_m.

/// A constant error of the range: one offset for all, and a normal one of each ring, drawn once for
/// the life of the sensor.
struct RangeBias {
  double offset_m = 0.0;
  double sigma_m = 0.0;
};

/// A wandering error of the range, a stationary Gauss-Markov process over the frames: standard
/// deviation sigma, correlation exp(-dt / tau).
struct RangeDrift {
  double sigma_m = 0.0;
  double tau_s = 1.0;
  bool per_ring = false;  ///< each ring wanders on its own
};

/// The process of standard deviation 1 at a frame, without walking through the frames before.
/// Frames 0, M, 2M ... have independent values, M = 2^L being so long that less than 1e-6 of the
/// correlation is left. Between them the middle of two known frames, h away from each, is drawn
/// from its distribution given both, of mean (a + b) p / (1 + p^2) and variance (1 - p^2) /
/// (1 + p^2), p = exp(-h dt / tau), and so on down to the frame asked for. A frame's normal number
/// is that of draw.frame = the frame, so that it takes part in the same way whoever asks.
double drift_at(std::uint32_t frame, double frames_per_tau, RngKey draw);

void apply(const RangeBias& step, const NoiseView& view, NoiseBatch& batch);
void apply(const RangeDrift& step, const NoiseView& view, NoiseBatch& batch);

}  // namespace glidar
