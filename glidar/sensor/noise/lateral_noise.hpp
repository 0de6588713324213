// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/elementary.hpp>
#include <glidar/sensor/noise/noise_batch.hpp>

#include <cmath>
#include <numbers>

namespace glidar {

/// Models that diverge towards grazing incidence are limited to their value at 1 degree from it.
inline constexpr double kMinGrazing_rad = std::numbers::pi / 180.0;

/// Maximum reach of a pixel's window to each side, in pixels.
inline constexpr std::size_t kMaxWindowReach = 16;

/// The angle in [0, pi/2] of a cosine.
inline double angle_of(double cosine) {
  const double square = 1.0 - cosine * cosine;
  const double sine = std::sqrt(square > 0.0 ? square : 0.0);
  return 2.0 * std::numbers::pi * atan2_turns(sine, cosine);
}

/// Stores the depths of a batch in the workspace for its neighbours.
void store_depth(const NoiseView& view, const NoiseBatch& batch);

/// Gives each beam the depth at an offset of (first, second) = (columns, rows) pixels: bilinear
/// between the four nearest pixels, or that of the nearest if one of them has no depth. If the
/// nearest has none either, the return is lost. Offsets are clamped to the image.
void shift_laterally(const PairBatch& shift_px, const NoiseView& view, NoiseBatch& batch);

/// Means of the white noise in the workspace over a window around each pixel, clipped to the image,
/// scaled to a standard deviation of 1.
void mean_over_window(unsigned window, const NoiseView& view, const NoiseBatch& batch,
                      Batch<double>& means);

}  // namespace glidar
