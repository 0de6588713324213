// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/noise/noise_batch.hpp>
#include <glidar/sensor/noise/tof_noise.hpp>

#include <array>
#include <span>

namespace glidar {

/// The light's waves in the pixels of a run.
struct alignas(64) WavePhases {
  std::array<Batch<double>, kMaxFrequencies> turns;
  Batch<double> coherence;  ///< the least |sum| / sum of amplitudes of all frequencies
  Batch<double> amplitude;
};

/// Waves of a pixel and, with the share `multipath_fraction`, of the eight around it that see
/// something, from the ranges and amplitudes that the scratch keeps; per_m: waves per metre of
/// range.
void mix(double mixing, std::span<const double> per_m, const NoiseView& view,
         const NoiseBatch& batch, WavePhases& phases);

}  // namespace glidar
