// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/tof_images.hpp>
#include <glidar/math/random.hpp>
#include <glidar/tof/tof_camera.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace glidar {

/// The correlation of the light with the reference at a phase in turns, from -1 to 1.
double tof_correlation(TofWaveform waveform, double turns);

/// Frequencies and steps of a camera, prepared for many pixels.
struct TofSteps {
  TofWaveform waveform = TofWaveform::sine;
  std::size_t frequencies = 0;
  std::size_t taps = 0;
  std::array<double, kMaxTofFrequencies> per_m = {};  ///< periods per metre of range
  std::array<double, kMaxTofTaps> cosine = {};        ///< of the phase of each step
  std::array<double, kMaxTofTaps> sine = {};
};
TofSteps make_tof_steps(const TofCamera& camera);

/// The light that a pixel receives in one phase step, in electrons: of the illuminator, the same
/// times its correlation, and the background.
struct TofLight {
  double signal = 0.0;
  double correlated = 0.0;
  double background = 0.0;
};

/// Adds light of the illuminator that returns from a range (half of its whole way) to all phase
/// steps of a pixel, frequency by frequency.
void add_light(const TofSteps& steps, double range_m, double electrons,
               std::span<TofLight> of_steps);

/// The same for one phase step, of number frequency x taps + tap.
void add_light(const TofSteps& steps, double range_m, double electrons, std::size_t step,
               TofLight& light);

/// The mean electrons of the two wells.
std::array<double, 2> mean_electrons(const TofCamera& camera, std::size_t frequency,
                                     const TofLight& light);

/// The raw value of a phase step: both wells with shot noise (Poisson) and read noise (normal), and
/// their difference in levels; infinite when a well is full. `key` has the number of the step as
/// its block, and blocks above kMaxTofFrequencies x kMaxTofTaps are used too.
float expose(const TofCamera& camera, std::size_t frequency, const TofLight& light,
             const RngKey& key);

/// The same without noise.
float expose_without_noise(const TofCamera& camera, std::size_t frequency, const TofLight& light);

}  // namespace glidar
