// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace glidar {

struct NoiseBatch;
struct NoiseView;

/// The most frequencies that are used.
inline constexpr std::size_t kMaxFrequencies = 8;

/// Time of flight by continuous waves. At each frequency f the pixel measures the phase of
/// sum a exp(j 4 pi f R / c) over itself and, with the share `multipath_fraction`, over the pixels
/// around it, a being the intensity. Its error is normal, sigma = sqrt(B + A) / (sqrt 2 C A), A and
/// B the electrons of signal and background, C the contrast (Lange and Seitz, IEEE J. Quantum
/// Electronics 37 (2001), whose sigma_z is c / (4 pi f) times this). The distance is the one, up to
/// c / (2 gcd of the frequencies), that the phases fit best; greater ones wrap around. Phases count
/// with f^2, which makes it the mean of least variance, since every phase has the same error.
/// Where light of several distances cancels, |sum a exp| / sum a < min_coherence at some
/// frequency, or where the phases fit no distance (rms above max_phase_residual turns), the status
/// is wrapped.
struct ContinuousWave {
  std::vector<double> frequencies_hz{};
  double electrons_at_full_scale = 0.0;  ///< of an intensity of 1
  double background_electrons = 0.0;
  double contrast = 1.0;
  double mixing = 0.0;
  double min_coherence = 0.6;
  double max_phase_residual = 0.1;
};

/// The greatest range without ambiguity: c / (2 gcd), the frequencies rounded to whole hertz.
double unambiguous_m(const std::vector<double>& frequencies_hz);

/// Whether pixels mix their light with that of those around them.
inline bool mixes(const ContinuousWave& step) {
  return step.mixing > 0.0;
}

void prepare(const ContinuousWave& step, const NoiseView& view, NoiseBatch& batch);
void apply(const ContinuousWave& step, const NoiseView& view, NoiseBatch& batch);

}  // namespace glidar
