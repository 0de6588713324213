// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/elementary.hpp>
#include <glidar/sensor/noise/noise_batch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace glidar {

/// Laws that grow without bound towards grazing_coefficient incidence are cut off so far from it: 1
/// degree.
inline constexpr double kMinGrazing_rad = std::numbers::pi / 180.0;

/// The farthest that a pixel's window reaches to each side.
inline constexpr std::size_t kMaxWindowReach = 16;

/// The angle of a cosine from 0 to 1.
inline double angle_of(double cosine) {
  const double square = 1.0 - cosine * cosine;
  const double sine = std::sqrt(square > 0.0 ? square : 0.0);
  return 2.0 * std::numbers::pi * turns_of(sine, cosine);
}

/// Keeps the depths of a run in the scratch, for neighbours to see.
void keep_depth(const NoiseView& view, const NoiseBatch& batch);

/// Gives each beam the depth of the place (first, second) = (columns, rows) pixels away, bilinear
/// between the four pixels around it, or that of the nearest where one of them has none. Where the
/// nearest has none either, the return is lost. Places outside of the image are moved to its edge.
void look_aside(const PairBatch& shift_px, const NoiseView& view, NoiseBatch& batch);

/// Means of white noise kept in the scratch over a window around each pixel, as far as it lies in
/// the image, brought to a standard deviation of 1.
void mean_over_window(unsigned window, const NoiseView& view, const NoiseBatch& batch,
                      Batch<double>& means);

}  // namespace glidar
