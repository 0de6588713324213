// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/noise/tof_noise.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/math/unambiguous_range.hpp>
#include <glidar/sensor/noise/noise_batch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

namespace glidar {
namespace {

/// The modulation of the light in the pixels of a batch.
struct alignas(64) WavePhases {
  std::array<Batch<double>, kMaxFrequencies> turns;
  Batch<double> coherence;  ///< minimum of |sum| / sum of amplitudes over all frequencies
  Batch<double> amplitude;
};

/// Consecutive pixels of a row and one more at each end.
using Strip = std::array<double, kSampleBatch + 2>;

/// Ranges and amplitudes of the pixels of a row; amplitude 0: no return.
struct alignas(64) Echoes {
  Strip range_m;
  Strip amplitude;
};

/// Of three rows, the middle one and the sum of the other two.
struct alignas(64) Rows {
  Strip middle;
  Strip outer;
};

/// Loads the pixels [col - 1, col + count + 1) of a row, which may be outside the image.
void load_echoes(const NoiseView& view, std::ptrdiff_t row, std::ptrdiff_t col, std::size_t count,
                 Echoes& echoes) {
  const NoiseWorkspace& kept = view.workspace;
  const auto cols = static_cast<std::ptrdiff_t>(view.beams.cols);
  const bool is_inside = row >= 0 && row < static_cast<std::ptrdiff_t>(view.beams.rows);
  for (std::size_t k = 0; k < count + 2; ++k) {
    const std::ptrdiff_t c = col - 1 + static_cast<std::ptrdiff_t>(k);
    const auto at = static_cast<std::size_t>(row * cols + c);
    const bool has_return = is_inside && c >= 0 && c < cols && !std::isnan(kept.before[at]);
    echoes.range_m[k] = has_return ? kept.before[at] : 0.0;
    echoes.amplitude[k] = has_return ? double{kept.amplitude[at]} : 0.0;
  }
}

/// The phasors of a row: amplitude times cosine and sine of the phase.
GLIDAR_SIMD void make_phasors(const Echoes& echoes, double per_m, std::size_t count, Strip& real,
                              Strip& imaginary) {
  for (std::size_t k = 0; k < count; ++k) {
    const SineCosine wave = sincos_turns(echoes.range_m[k] * per_m);
    real[k] = echoes.amplitude[k] * wave.cosine;
    imaginary[k] = echoes.amplitude[k] * wave.sine;
  }
}

GLIDAR_SIMD void add(const Strip& a, const Strip& b, std::size_t count, Strip& sum) {
  for (std::size_t k = 0; k < count; ++k) sum[k] = a[k] + b[k];
}

/// The weights of a pixel itself and of each neighbour.
struct Shares {
  double own;
  double around;
};

double gathered(const Shares& shares, const Rows& rows, std::size_t k) {
  const double left = rows.middle[k] + rows.outer[k];
  const double right = rows.middle[k + 2] + rows.outer[k + 2];
  return shares.own * rows.middle[k + 1] + shares.around * (left + rows.outer[k + 1] + right);
}

GLIDAR_SIMD void gather_amplitude(const Shares& shares, const Rows& amplitude,
                                  std::span<double> out) {
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = gathered(shares, amplitude, k);
}

GLIDAR_SIMD void gather_phasors(const Shares& shares, const Rows& real, const Rows& imaginary,
                                const double* amplitude, std::span<double> turns,
                                double* coherence) {
  for (std::size_t k = 0; k < turns.size(); ++k) {
    const double x = gathered(shares, real, k);
    const double y = gathered(shares, imaginary, k);
    const double share = amplitude[k] > 0.0 ? std::sqrt(x * x + y * y) / amplitude[k] : 0.0;
    coherence[k] = share < coherence[k] ? share : coherence[k];
    turns[k] = atan2_turns(y, x);
  }
}

/// Three rows of echoes and their phasors.
struct Neighbourhood {
  Echoes above;
  Echoes middle;
  Echoes below;
  Rows amplitude;
  Rows real;
  Rows imaginary;
  Rows spare;
};

void make_rows(double per_m, std::size_t count, Neighbourhood& n) {
  make_phasors(n.middle, per_m, count, n.real.middle, n.imaginary.middle);
  make_phasors(n.above, per_m, count, n.real.outer, n.imaginary.outer);
  make_phasors(n.below, per_m, count, n.spare.middle, n.spare.outer);
  add(n.real.outer, n.spare.middle, count, n.real.outer);
  add(n.imaginary.outer, n.spare.outer, count, n.imaginary.outer);
}

/// Pixels of a batch that are in one row: `count` pixels from index `begin` of the batch.
struct PixelRun {
  std::size_t begin;
  std::size_t count;
};

void mix_row(const Shares& shares, std::span<const double> per_m, const PixelRun& row_run,
             Neighbourhood& n, WavePhases& phases) {
  const std::size_t wide = row_run.count + 2;
  double* amplitude = phases.amplitude.data() + row_run.begin;
  n.amplitude.middle = n.middle.amplitude;
  add(n.above.amplitude, n.below.amplitude, wide, n.amplitude.outer);
  gather_amplitude(shares, n.amplitude, {amplitude, row_run.count});
  for (std::size_t f = 0; f < per_m.size(); ++f) {
    make_rows(per_m[f], wide, n);
    gather_phasors(shares, n.real, n.imaginary, amplitude,
                   {phases.turns[f].data() + row_run.begin, row_run.count},
                   phases.coherence.data() + row_run.begin);
  }
}

/// Sums the modulation of a pixel and, with the share `multipath_fraction`, of its eight neighbours
/// that have a return, from the ranges and amplitudes in the workspace; per_m: waves per metre of
/// range.
void mix(double fraction, std::span<const double> per_m, const NoiseView& view,
         const NoiseBatch& batch, WavePhases& phases) {
  const Shares shares{1.0 - fraction, fraction / 8.0};
  const std::size_t cols = view.beams.cols;
  Neighbourhood n;
  phases.coherence.fill(1.0);
  for (std::size_t i = 0; i < batch.count;) {
    const std::size_t row = (batch.first + i) / cols;
    const std::size_t col = (batch.first + i) % cols;
    const std::size_t count = std::min(cols - col, batch.count - i);
    const auto r = static_cast<std::ptrdiff_t>(row);
    const auto c = static_cast<std::ptrdiff_t>(col);
    load_echoes(view, r - 1, c, count, n.above);
    load_echoes(view, r, c, count, n.middle);
    load_echoes(view, r + 1, c, count, n.below);
    mix_row(shares, per_m, {i, count}, n, phases);
    i += count;
  }
}

constexpr double kMinAmplitude = 1e-9;

/// The frequencies, the highest first, and derived constants of the search for the range.
struct Waves {
  std::size_t count = 0;
  double finest_m = 0.0;                            ///< range of one wave of the highest frequency
  double limit_m = 0.0;                             ///< unambiguous range
  double number = 0.0;                              ///< waves of the highest frequency in limit_m
  double sigma_m_per_turn = 0.0;                    ///< sigma of the range over that of the phases
  std::array<double, kMaxFrequencies> per_m{};      ///< waves per metre of range
  std::array<double, kMaxFrequencies> to_finest{};  ///< frequency over the highest
  std::array<double, kMaxFrequencies> weight{};     ///< f^2 over the sum of all; 0: unused
};

Waves waves_of(const std::vector<double>& frequencies_hz) {
  Waves waves;
  waves.count = std::min(frequencies_hz.size(), kMaxFrequencies);
  std::array<double, kMaxFrequencies> f{};
  std::copy_n(frequencies_hz.begin(), waves.count, f.begin());
  std::iter_swap(f.begin(), std::max_element(f.begin(), f.end()));
  double squares = 0.0;
  for (const double f_hz : f) squares += f_hz * f_hz;
  for (std::size_t k = 0; k < waves.count; ++k) {
    waves.per_m[k] = f[k] / kHalfLight_m_per_s;
    waves.to_finest[k] = f[k] / f[0];
    waves.weight[k] = f[k] * f[k] / squares;
  }
  waves.finest_m = kHalfLight_m_per_s / f[0];
  waves.limit_m = unambiguous_range_m(frequencies_hz);
  constexpr double kPhaseRounding = 1e-12;
  waves.number = std::ceil(waves.limit_m / waves.finest_m * (1.0 - kPhaseRounding));
  waves.sigma_m_per_turn = kHalfLight_m_per_s / std::sqrt(squares);
  return waves;
}

/// The integer number of waves of the highest frequency that fits best, and its residual.
struct alignas(64) BestFit {
  Batch<double> whole;
  Batch<double> residual;  ///< mean square in turns^2, with Waves::weight
};

GLIDAR_SIMD void phase_of_range(double per_m, const Batch<double>& range_m, Batch<double>& turns) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    const double waves = range_m[i] * per_m;
    turns[i] = waves - std::floor(waves);
  }
}

/// Standard deviation of the phase in turns, for a batch.
GLIDAR_SIMD void phase_sigma(const ContinuousWave& model, const Batch<double>& amplitude,
                             const Batch<double>& scale, Batch<double>& sigma_turns) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    const double light = amplitude[i] > kMinAmplitude ? amplitude[i] : kMinAmplitude;
    const double signal = model.electrons_at_full_scale * light;
    sigma_turns[i] = std::sqrt(0.5 * (model.background_electrons + signal)) /
                     (model.contrast * signal) * scale[i] * (0.5 * std::numbers::inv_pi);
  }
}

GLIDAR_SIMD void add_error(const Batch<double>& sigma_turns, const Batch<double>& normal,
                           Batch<double>& turns) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    const double perturbed = turns[i] + sigma_turns[i] * normal[i];
    turns[i] = perturbed - std::floor(perturbed);
  }
}

/// Subtracts the phase that the phase of the highest frequency implies, up to whole waves of it.
GLIDAR_SIMD void subtract_finest(double to_finest, const Batch<double>& finest,
                                 Batch<double>& turns) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) turns[i] -= finest[i] * to_finest;
}

/// The residual of a phase for `whole` waves of the highest frequency, in [-1/2, 1/2).
inline double phase_residual(double difference_turns, double whole, double to_finest) {
  const double error = difference_turns - whole * to_finest;
  return error - std::floor(error + 0.5);
}

/// Weighted mean square of the phase residuals of kOthers frequencies for `whole` waves.
template <std::size_t kOthers>
[[gnu::always_inline]] inline double residual_of(const Waves& waves, const WavePhases& phases,
                                                 std::size_t i, double whole) {
  double residual = 0.0;
#pragma GCC unroll 8
  for (std::size_t k = 1; k <= kOthers; ++k) {
    const double error = phase_residual(phases.turns[k][i], whole, waves.to_finest[k]);
    residual += waves.weight[k] * error * error;
  }
  return residual;
}

/// Tries all integer numbers of waves of the highest frequency.
template <std::size_t kOthers>
[[gnu::always_inline]] inline void try_all(const Waves& waves, const WavePhases& phases,
                                           BestFit& best) {
  for (double whole = 0.0; whole < waves.number; whole += 1.0) {
    for (std::size_t i = 0; i < kSampleBatch; ++i) {
      const double residual = residual_of<kOthers>(waves, phases, i, whole);
      const bool is_better = residual < best.residual[i];
      best.residual[i] = is_better ? residual : best.residual[i];
      best.whole[i] = is_better ? whole : best.whole[i];
    }
  }
}

GLIDAR_SIMD void search_two(const Waves& waves, const WavePhases& phases, BestFit& best) {
  try_all<1>(waves, phases, best);
}
GLIDAR_SIMD void search_three(const Waves& waves, const WavePhases& phases, BestFit& best) {
  try_all<2>(waves, phases, best);
}
GLIDAR_SIMD void search_many(const Waves& waves, const WavePhases& phases, BestFit& best) {
  try_all<kMaxFrequencies - 1>(waves, phases, best);
}

/// The range from the integer number of waves and the phase of the highest frequency.
GLIDAR_SIMD void start_range(double finest_m, const Batch<double>& finest, const BestFit& found,
                             Batch<double>& range_m) {
  for (std::size_t i = 0; i < kSampleBatch; ++i)
    range_m[i] = (finest[i] + found.whole[i]) * finest_m;
}

/// Adds the correction by the phase of another frequency.
GLIDAR_SIMD void refine_range(double to_finest, double weight_m, const Batch<double>& turns,
                              const BestFit& found, Batch<double>& range_m) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    range_m[i] += weight_m * phase_residual(turns[i], found.whole[i], to_finest);
  }
}

GLIDAR_SIMD void finish_range(const Waves& waves, const Batch<double>& sigma_turns,
                              NoiseBatch& batch) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    const double range_m = batch.range_m[i];
    const double sigma_m = sigma_turns[i] * waves.sigma_m_per_turn;
    batch.range_m[i] = range_m < 0.0 ? range_m + waves.limit_m : range_m;
    batch.variance_m2[i] += sigma_m * sigma_m;
  }
}

/// The phases without noise, and their coherence.
void measure_phases(const ContinuousWave& step, const Waves& waves, const NoiseView& view,
                    const NoiseBatch& batch, WavePhases& phases) {
  if (has_multipath(step)) {
    mix(step.multipath_fraction, {waves.per_m.data(), waves.count}, view, batch, phases);
    return;
  }
  phases.amplitude = batch.intensity;
  phases.coherence.fill(1.0);
  for (std::size_t k = 0; k < waves.count; ++k) {
    phase_of_range(waves.per_m[k], batch.range_m, phases.turns[k]);
  }
}

void add_errors(const Sampler& sampler, std::size_t count, const Batch<double>& sigma_turns,
                WavePhases& phases) {
  WordBatch words;
  PairBatch normals;
  for (std::size_t k = 0; k < count; ++k) {
    if (k % 4 == 0) sample_words(block(sampler, static_cast<std::uint32_t>(k / 4)), {}, words);
    if (k % 2 == 0) box_muller(words, k % 4 / 2, normals);
    const Batch<double>& normal = k % 2 == 0 ? normals.first : normals.second;
    const char* use = k == 0 ? "error of the highest frequency's phase" : "error of a phase";
    record_normal(sampler, use, normal);
    add_error(sigma_turns, normal, phases.turns[k]);
  }
}

/// The range that fits the phases best; overwrites the phases.
void unwrap(const Waves& waves, WavePhases& phases, BestFit& found, Batch<double>& range_m) {
  for (std::size_t k = 1; k < waves.count; ++k) {
    subtract_finest(waves.to_finest[k], phases.turns[0], phases.turns[k]);
  }
  for (std::size_t k = waves.count; k < kMaxFrequencies; ++k) {
    if (waves.count > 3) phases.turns[k].fill(0.0);  // search_many() uses all of them
  }
  found.whole.fill(0.0);
  found.residual.fill(waves.count > 1 ? 1.0 : 0.0);  // above the maximum of 1/4
  if (waves.count == 2) search_two(waves, phases, found);
  if (waves.count == 3) search_three(waves, phases, found);
  if (waves.count > 3) search_many(waves, phases, found);
  start_range(waves.finest_m, phases.turns[0], found, range_m);
  for (std::size_t k = 1; k < waves.count; ++k) {
    refine_range(waves.to_finest[k], waves.weight[k] / waves.per_m[k], phases.turns[k], found,
                 range_m);
  }
}

/// A pixel tries all ranges at which the finest wave has the same phase, one by one.
void check_frequencies(const ContinuousWave& step, FieldVisitor& visitor) {
  const std::vector<double>& all = step.frequencies_hz;
  const double finest = *std::max_element(all.begin(), all.end());
  constexpr double kMaxWaves = 1000.0;
  if (finest * unambiguous_range_m(all) <= kMaxWaves * kHalfLight_m_per_s) return;
  visitor.reject("frequencies_hz",
                 "their greatest common divisor is below a thousandth of the greatest",
                 "frequencies in simple ratios", "round them to whole MHz");
}

}  // namespace

void prepare(const ContinuousWave& /*step*/, const NoiseView& view, NoiseBatch& batch) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    view.workspace.before[batch.first + i] = batch.range_m[i];
    view.workspace.amplitude[batch.first + i] = static_cast<float>(batch.intensity[i]);
  }
}

void apply(const ContinuousWave& step, const NoiseView& view, NoiseBatch& batch) {
  const Waves waves = waves_of(step.frequencies_hz);
  WavePhases phases;
  Batch<double> sigma_turns;
  BestFit found;
  measure_phases(step, waves, view, batch, phases);
  phase_sigma(step, phases.amplitude, batch.scale, sigma_turns);
  add_errors(batch.sampler, waves.count, sigma_turns, phases);
  unwrap(waves, phases, found, batch.range_m);
  finish_range(waves, sigma_turns, batch);
  const double max_residual = step.max_phase_residual * step.max_phase_residual;
  for (std::size_t i = 0; i < batch.count; ++i) {
    const bool is_clear =
        phases.coherence[i] >= step.min_coherence && found.residual[i] <= max_residual;
    if (!is_clear && is_hit(batch, i)) invalidate_return(batch, i, Status::phase_ambiguous);
  }
}

void describe(ContinuousWave& step, FieldVisitor& visitor) {
  constexpr NumberRule kFrequency = {1.0, 1e12, false, "hertz from 1 to 1e12"};
  constexpr NumberRule kUpToOne = {1e-9, 1.0, false, "a number above 0, up to 1"};
  constexpr NumberRule kBelowOne = {0.0, 1.0 - 1e-9, false, "a number from 0 to below 1"};
  visitor.number({"electrons_at_full_scale", "A of an intensity of 1", kNoUnit, kRequired},
                 kAboveZero, step.electrons_at_full_scale);
  visitor.number({"background_electrons", "B"}, kFromZero, step.background_electrons);
  visitor.number({"contrast", "C, of the demodulation"}, kUpToOne, step.contrast);
  visitor.number({"multipath_fraction", "share of light from neighbouring pixels"}, kBelowOne,
                 step.multipath_fraction);
  visitor.number({"min_coherence", "below it, mixed waves cancel"}, kZeroToOne, step.min_coherence);
  visitor.number({"max_phase_residual", "above it, phases fit no range; rms, in turns"}, kFromZero,
                 step.max_phase_residual);
  visitor.numbers(
      {"frequencies_hz", "of the modulation; 1 to 8 in simple ratios", kUnitHertz, kRequired},
      {.number = kFrequency, .max_size = kMaxFrequencies, .allowed = "1 to 8 frequencies"},
      step.frequencies_hz);
  if (visitor.is_reading()) check_frequencies(step, visitor);
}

}  // namespace glidar
