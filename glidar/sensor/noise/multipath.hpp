// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/noise/noise_batch.hpp>
#include <glidar/sensor/noise/tof_noise.hpp>

#include <array>
#include <span>

namespace glidar {

/// The modulation of the light in the pixels of a batch.
struct alignas(64) WavePhases {
  std::array<Batch<double>, kMaxFrequencies> turns;
  Batch<double> coherence;  ///< minimum of |sum| / sum of amplitudes over all frequencies
  Batch<double> amplitude;
};

/// Sums the modulation of a pixel and, with the share `multipath_fraction`, of its eight neighbours
/// that have a return, from the ranges and amplitudes in the workspace; per_m: waves per metre of
/// range.
void mix(double fraction, std::span<const double> per_m, const NoiseView& view,
         const NoiseBatch& batch, WavePhases& phases);

}  // namespace glidar
