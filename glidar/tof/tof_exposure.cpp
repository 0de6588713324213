// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/tof/tof_exposure.hpp>

#include <glidar/math/elementary.hpp>
#include <glidar/math/gaussian.hpp>
#include <glidar/math/light_speed.hpp>
#include <glidar/math/poisson.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

/// Blocks from here on are those of uniform numbers.
constexpr std::uint32_t kBlocksOfNormals = kMaxTofFrequencies * kMaxTofTaps;

float to_level(const TofCamera& camera, double plus, double minus) {
  if (std::max(plus, minus) >= camera.full_well_electrons) return kInfinityf;
  const double level = (plus - minus) / camera.electrons_per_level;
  return static_cast<float>(camera.has_whole_levels ? std::floor(level + 0.5) : level);
}

}  // namespace

double tof_correlation(TofWaveform waveform, double turns) {
  if (waveform == TofWaveform::sine) return sincos_turns(turns).cosine;
  return 1.0 - 4.0 * std::abs(turns - std::floor(turns + 0.5));
}

TofSteps make_tof_steps(const TofCamera& camera) {
  TofSteps steps;
  steps.waveform = camera.waveform;
  steps.frequencies = camera.decoder.frequencies_hz.size();
  steps.taps = camera.decoder.taps;
  for (std::size_t f = 0; f < steps.frequencies; ++f) {
    steps.per_m[f] = camera.decoder.frequencies_hz[f] / kHalfLight_m_per_s;
  }
  for (std::size_t k = 0; k < steps.taps; ++k) {
    const SineCosine wave = sincos_turns(static_cast<double>(k) / static_cast<double>(steps.taps));
    steps.cosine[k] = wave.cosine;
    steps.sine[k] = wave.sine;
  }
  return steps;
}

void add_light(const TofSteps& steps, double range_m, double electrons,
               std::span<TofLight> of_steps) {
  for (std::size_t f = 0; f < steps.frequencies; ++f) {
    const double turns = range_m * steps.per_m[f];
    const SineCosine wave = sincos_turns(turns);
    for (std::size_t k = 0; k < steps.taps; ++k) {
      TofLight& light = of_steps[f * steps.taps + k];
      const double correlation =
          steps.waveform == TofWaveform::sine
              ? wave.cosine * steps.cosine[k] + wave.sine * steps.sine[k]
              : tof_correlation(steps.waveform,
                                turns - static_cast<double>(k) / static_cast<double>(steps.taps));
      light.signal += electrons;
      light.correlated += electrons * correlation;
    }
  }
}

void add_light(const TofSteps& steps, double range_m, double electrons, std::size_t step,
               TofLight& light) {
  const std::size_t f = step / steps.taps;
  const std::size_t k = step % steps.taps;
  const double turns =
      range_m * steps.per_m[f] - static_cast<double>(k) / static_cast<double>(steps.taps);
  light.signal += electrons;
  light.correlated += electrons * tof_correlation(steps.waveform, turns);
}

std::array<double, 2> mean_electrons(const TofCamera& camera, std::size_t frequency,
                                     const TofLight& light) {
  const double contrast = camera.contrast.empty() ? 1.0 : camera.contrast[frequency];
  const double all = light.background + light.signal;
  const double difference = contrast * light.correlated;
  return {std::max(0.0, 0.5 * (all + difference)), std::max(0.0, 0.5 * (all - difference))};
}

float expose(const TofCamera& camera, std::size_t frequency, const TofLight& light,
             const RngKey& key) {
  const std::array<double, 2> mean = mean_electrons(camera, frequency, light);
  const std::array<double, 4> normal = normals(random_words(key));
  RandomWords words = {};
  if (std::min(mean[0], mean[1]) < kPoissonInversionLimit) {
    RngKey other = key;
    other.block += kBlocksOfNormals;
    words = random_words(other);
  }
  const double plus = sample_poisson(mean[0], uniform(words[0]), normal[0]);
  const double minus = sample_poisson(mean[1], uniform(words[1]), normal[1]);
  const double read = camera.read_noise_electrons;
  return to_level(camera, plus + read * normal[2], minus + read * normal[3]);
}

float expose_without_noise(const TofCamera& camera, std::size_t frequency, const TofLight& light) {
  const std::array<double, 2> mean = mean_electrons(camera, frequency, light);
  return to_level(camera, mean[0], mean[1]);
}

}  // namespace glidar
