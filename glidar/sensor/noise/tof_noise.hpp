// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>

#include <cstddef>
#include <vector>

namespace glidar {

class FieldVisitor;
struct NoiseBatch;
struct NoiseView;

/// Maximum number of modulation frequencies.
inline constexpr std::size_t kMaxFrequencies = 8;

/// Continuous-wave time of flight. At each frequency f the pixel measures the phase of
/// sum a exp(j 4 pi f R / c) over itself and, with the share `multipath_fraction`, over its
/// neighbours, where a is the intensity. The phase error is normal with
/// sigma = sqrt(B + A) / (sqrt 2 C A), A and B the electrons of signal and background, C the
/// contrast (Lange and Seitz, IEEE J. Quantum Electronics 37 (2001), whose sigma_z is c / (4 pi f)
/// times this). The range is the best fit to the phases up to c / (2 gcd of the frequencies);
/// larger ranges wrap around. Phases have the weight f^2, which gives the mean of minimum variance
/// because all phases have the same error. The status is phase_ambiguous where light of several
/// ranges cancels (|sum a exp| / sum a < min_coherence at some frequency), or where no range fits
/// the phases (rms above max_phase_residual turns).
struct ContinuousWave {
  static constexpr TypeInfo kType = {
      "continuous_wave",
      "phases of mixed waves with errors √((B+A)/2)/(C A), the range that fits best; "
      "`phase_ambiguous` where waves cancel or the phases fit no range",
      "Lange and Seitz, IEEE JQE 37 (2001)"};
  std::vector<double> frequencies_hz{};
  double electrons_at_full_scale = 0.0;  ///< at intensity 1
  double background_electrons = 0.0;
  double contrast = 1.0;
  double multipath_fraction = 0.0;
  double min_coherence = 0.6;
  double max_phase_residual = 0.1;
};

/// True if pixels mix their light with that of their neighbours.
inline bool has_multipath(const ContinuousWave& step) {
  return step.multipath_fraction > 0.0;
}

/// Keys in sensor files.
void describe(ContinuousWave& step, FieldVisitor& visitor);

void prepare(const ContinuousWave& step, const NoiseView& view, NoiseBatch& batch);
void apply(const ContinuousWave& step, const NoiseView& view, NoiseBatch& batch);

}  // namespace glidar
