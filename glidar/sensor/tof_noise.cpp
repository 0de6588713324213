// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/tof_noise.hpp>

#include <glidar/core/elementary.hpp>
#include <glidar/sensor/noise_batch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace glidar {
namespace {

constexpr double kHalfLight_m_per_s = 0.5 * 299792458.0;
constexpr double kDarkest = 1e-9;
constexpr std::size_t kMostFrequencies = 8;
constexpr std::size_t kNeighbourhood = 9;

/// The pixel's own echo and, when it mixes, those around it.
std::size_t gather(const ContinuousWave& step, const NoiseView& view, std::size_t beam,
                   std::array<Echo, kNeighbourhood>& echoes) {
  const Scratch& kept = view.frame.scratch;
  const auto cols = static_cast<std::ptrdiff_t>(view.beams.cols);
  const auto rows = static_cast<std::ptrdiff_t>(view.beams.rows);
  const auto row = static_cast<std::ptrdiff_t>(beam) / cols;
  const auto col = static_cast<std::ptrdiff_t>(beam) % cols;
  echoes[0] = {(1.0 - step.mixing) * double{kept.amplitude[beam]}, kept.before[beam]};
  std::size_t count = 1;
  if (!(step.mixing > 0.0)) return count;
  for (std::ptrdiff_t k = 0; k < 9; ++k) {
    const std::ptrdiff_t r = row + k / 3 - 1;
    const std::ptrdiff_t c = col + k % 3 - 1;
    if (k == 4 || r < 0 || r >= rows || c < 0 || c >= cols) continue;
    const auto at = static_cast<std::size_t>(r * cols + c);
    if (std::isnan(kept.before[at])) continue;
    echoes[count++] = {step.mixing / 8.0 * double{kept.amplitude[at]}, kept.before[at]};
  }
  return count;
}

double total(std::span<const Echo> echoes) {
  return std::accumulate(echoes.begin(), echoes.end(), 0.0,
                         [](double sum, const Echo& echo) { return sum + echo.amplitude; });
}

/// The phases of all frequencies with their errors; the least coherence among them.
double measure_phases(const ContinuousWave& step, std::span<const Echo> echoes, double sigma_turns,
                      const Draw& draw, std::span<double> turns) {
  double least = 1.0;
  for (std::size_t f = 0; f < turns.size(); ++f) {
    const Phasor phasor = mixed_phasor(echoes, step.frequencies_hz[f]);
    const auto number = static_cast<std::uint32_t>(f / 4);
    const double normal = normals(random_words(block(draw, number)))[f % 4];
    const double with_error = phasor.turns + sigma_turns * normal;
    turns[f] = with_error - std::floor(with_error);
    least = std::min(least, phasor.coherence);
  }
  return least;
}

}  // namespace

Phasor mixed_phasor(std::span<const Echo> echoes, double frequency_hz) {
  double real = 0.0;
  double imaginary = 0.0;
  for (const Echo& echo : echoes) {
    const SineCosine wave = of_turns(echo.range_m * frequency_hz / kHalfLight_m_per_s);
    real += echo.amplitude * wave.cosine;
    imaginary += echo.amplitude * wave.sine;
  }
  const double sum = total(echoes);
  const double length = std::sqrt(real * real + imaginary * imaginary);
  return {turns_of(imaginary, real), sum > 0.0 ? length / sum : 0.0};
}

double phase_sigma_rad(const ContinuousWave& law, double amplitude) {
  const double signal = law.electrons_at_full_scale * std::max(amplitude, kDarkest);
  return std::sqrt(0.5 * (law.background_electrons + signal)) / (law.contrast * signal);
}

double unambiguous_m(const std::vector<double>& frequencies_hz) {
  std::uint64_t common = 0;
  for (const double f : frequencies_hz) {
    common = std::gcd(common, static_cast<std::uint64_t>(std::llround(f)));
  }
  return kHalfLight_m_per_s / static_cast<double>(std::max<std::uint64_t>(common, 1));
}

Unwrapped unwrap(const std::vector<double>& frequencies_hz, std::span<const double> turns,
                 double limit_m) {
  const auto finest = static_cast<std::size_t>(
      std::max_element(frequencies_hz.begin(), frequencies_hz.end()) - frequencies_hz.begin());
  const double wave_m = kHalfLight_m_per_s / frequencies_hz[finest];
  double weights = 0.0;
  for (const double f : frequencies_hz) weights += f * f;
  Unwrapped best{0.0, std::numeric_limits<double>::infinity()};
  for (double whole = 0.0; whole * wave_m < limit_m * (1.0 - 1e-12); whole += 1.0) {
    const double candidate_m = (turns[finest] + whole) * wave_m;
    double shift = 0.0;  // sum of weight times the range's change that each phase asks for
    double misfit = 0.0;
    for (std::size_t f = 0; f < turns.size(); ++f) {
      const double per_m = frequencies_hz[f] / kHalfLight_m_per_s;
      const double apart = turns[f] - candidate_m * per_m;
      const double error = apart - std::floor(apart + 0.5);
      const double weight = frequencies_hz[f] * frequencies_hz[f] / weights;
      shift += weight * error / per_m;
      misfit += weight * error * error;
    }
    const double rms = std::sqrt(misfit);
    if (rms < best.misfit_turns) best = {candidate_m + shift, rms};
  }
  if (best.range_m < 0.0) best.range_m += limit_m;
  return best;
}

void prepare(const ContinuousWave& /*step*/, const NoiseView& view, NoiseBatch& batch) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    view.frame.scratch.before[batch.first + i] = batch.range_m[i];
    view.frame.scratch.amplitude[batch.first + i] = static_cast<float>(batch.intensity[i]);
  }
}

void apply(const ContinuousWave& step, const NoiseView& view, NoiseBatch& batch) {
  constexpr double kTurn_rad = 2.0 * std::numbers::pi;
  const double limit_m = unambiguous_m(step.frequencies_hz);
  double squares = 0.0;
  for (const double f : step.frequencies_hz) squares += f * f;
  std::array<Echo, kNeighbourhood> echoes;
  std::array<double, kMostFrequencies> turns;
  const std::span<double> used(turns.data(),
                               std::min(step.frequencies_hz.size(), kMostFrequencies));
  Draw draw = batch.draw;
  for (std::size_t i = 0; i < batch.count; ++i) {
    if (!is_hit(batch, i)) continue;
    const std::size_t beam = batch.first + i;
    draw.beam = static_cast<std::uint32_t>(beam);
    const std::span<const Echo> light(echoes.data(), gather(step, view, beam, echoes));
    const double sigma_turns = phase_sigma_rad(step, total(light)) * batch.scale[i] / kTurn_rad;
    const double coherence = measure_phases(step, light, sigma_turns, draw, used);
    const Unwrapped found = unwrap(step.frequencies_hz, used, limit_m);
    if (coherence < step.least_coherence || found.misfit_turns > step.largest_misfit) {
      lose(batch, i, Status::wrapped);
      continue;
    }
    batch.range_m[i] = found.range_m;
    const double sigma_m = sigma_turns * kHalfLight_m_per_s / std::sqrt(squares);
    batch.variance_m2[i] += sigma_m * sigma_m;
  }
}

}  // namespace glidar
