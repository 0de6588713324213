// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace glidar {

struct NoiseBatch;
struct NoiseView;

/// Time of flight by continuous waves. At each frequency f the pixel measures the phase of
/// sum a exp(j 4 pi f R / c) over itself and, with the share `mixing`, over the pixels around it,
/// a being the intensity. Its error is normal, sigma = sqrt(B + A) / (sqrt 2 C A), A and B the
/// electrons of signal and background, C the contrast (Lange and Seitz, IEEE J. Quantum
/// Electronics 37 (2001), whose sigma_z is c / (4 pi f) times this). The distance is the one, up to
/// c / (2 gcd of the frequencies), that the phases fit best; greater ones wrap around.
/// Where light of several distances cancels, |sum a exp| / sum a < least_coherence at some
/// frequency, or where the phases fit no distance (rms above largest_misfit turns), the status is
/// wrapped.
struct ContinuousWave {
  std::vector<double> frequencies_hz{};
  double electrons_at_full_scale = 0.0;  ///< of an intensity of 1
  double background_electrons = 0.0;
  double contrast = 1.0;
  double mixing = 0.0;
  double least_coherence = 0.6;
  double largest_misfit = 0.1;
};

/// Light of one distance in a pixel.
struct Echo {
  double amplitude;
  double range_m;
};

struct Phasor {
  double turns;      ///< phase, 0 to below 1
  double coherence;  ///< |sum| / sum of amplitudes
};

/// The sum of the echoes' waves at a frequency.
Phasor mixed_phasor(std::span<const Echo> echoes, double frequency_hz);

/// Standard deviation of the phase, radians.
double phase_sigma_rad(const ContinuousWave& law, double amplitude);

/// The greatest range without ambiguity: c / (2 gcd), the frequencies rounded to whole hertz.
double unambiguous_m(const std::vector<double>& frequencies_hz);

struct Unwrapped {
  double range_m;
  double misfit_turns;  ///< rms over the frequencies, weighted as the range is
};

/// The range from 0 to limit_m that fits the phases best. Weights f^2 make it the mean of least
/// variance, since every phase has the same error.
Unwrapped unwrap(const std::vector<double>& frequencies_hz, std::span<const double> turns,
                 double limit_m);

void prepare(const ContinuousWave& step, const NoiseView& view, NoiseBatch& batch);
void apply(const ContinuousWave& step, const NoiseView& view, NoiseBatch& batch);

}  // namespace glidar
