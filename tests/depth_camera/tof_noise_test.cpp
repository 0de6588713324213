// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <depth_camera/tof_pictures.hpp>
#include <glidar/depth_camera/time_of_flight.hpp>
#include <glidar/math/constants.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace glidar {
namespace {

using testing::expose_noisy_scene;
using testing::expose_scene;
using testing::plain_camera;
using testing::TofTarget;

/// The difference of two angles in turns, in (-1/2, 1/2].
double turn_difference(double a, double b) {
  const double difference = a - b;
  return difference - std::round(difference);
}

/// Standard deviation of the phase over 200 x 200 pixels, whose relative error is 0.35 %.
double measured_phase_sigma(const TofCamera& camera, const TofTarget& target) {
  const TofImages images = expose_noisy_scene(
      camera, 200, 200, [&](std::uint32_t, std::uint32_t) { return target; }, 1);
  const TofMeasurement measured = decode_tof(images, camera.decoder);
  const double turns = target.range_m * camera.decoder.frequencies_hz[0] / kHalfLight_m_per_s;
  double squares = 0.0;
  for (const float phase : measured.phase_rad) {
    squares += std::pow(turn_difference(static_cast<double>(phase) / kTwoPi, turns), 2.0);
  }
  return kTwoPi * std::sqrt(squares / static_cast<double>(measured.phase_rad.size()));
}

TEST(TofNoise, PhaseErrorsFollowTheShotNoiseLaw) {
  constexpr double kContrast = 0.6;
  for (const std::uint32_t taps : {3U, 4U, 8U}) {
    for (const double signal : {2e3, 5e4}) {
      TofCamera camera = plain_camera({80e6}, taps);
      camera.contrast = {kContrast};
      const TofTarget target{.range_m = 1.3, .electrons = signal, .background = 3e3};
      // sigma^2 = 2 (A + B) / (N m^2 A^2): N independent differences of variance A + B.
      const double law =
          std::sqrt(2.0 * (signal + target.background) / taps) / (kContrast * signal);
      EXPECT_NEAR(measured_phase_sigma(camera, target) / law, 1.0, 0.02) << taps << " " << signal;
    }
  }
}

TEST(TofNoise, ReadNoiseOfBothWellsAddsToTheShotNoise) {
  TofCamera camera = plain_camera({80e6}, 4);
  camera.read_noise_electrons = 40.0;
  const TofTarget target{.range_m = 0.4, .electrons = 2e3, .background = 500.0};
  const double variance = 2500.0 + 2.0 * 40.0 * 40.0;
  EXPECT_NEAR(measured_phase_sigma(camera, target) / (std::sqrt(0.5 * variance) / 2e3), 1.0, 0.02);
}

TEST(TofNoise, FewElectronsFollowTheSameLaw) {
  const TofCamera camera = plain_camera({80e6}, 4);
  const TofTarget target{.range_m = 0.4, .electrons = 40.0, .background = 1.0};
  // The law is the first order in sigma; at 0.11 rad the next one adds below 1 %.
  EXPECT_NEAR(measured_phase_sigma(camera, target) / (std::sqrt(0.5 * 41.0) / 40.0), 1.0, 0.03);
}

double max_phase_error(std::uint32_t taps) {
  TofCamera camera = plain_camera({80e6}, taps);
  camera.waveform = TofWaveform::triangle;
  constexpr std::uint32_t kRanges = 6000;
  const double period_m = kHalfLight_m_per_s / 80e6;
  const TofImages images =
      expose_scene(camera, kRanges, 1, [&](std::uint32_t column, std::uint32_t) {
        return TofTarget{.range_m = period_m * column / kRanges};
      });
  const TofMeasurement measured = decode_tof(images, camera.decoder);
  double greatest = 0.0;
  for (std::uint32_t i = 0; i < kRanges; ++i) {
    const double error =
        turn_difference(measured.range_m[i] / period_m, static_cast<double>(i) / kRanges);
    greatest = std::max(greatest, std::abs(error) * kTwoPi);
  }
  return greatest;
}

/// The greatest phase error from the harmonics of a triangle, 1 / n^2 of odd n, of which N steps
/// keep those with n = +-1 modulo N: sum cos(n phi) / n^2 aliases to exp(+-j n phi).
double max_alias_error(unsigned taps) {
  constexpr int kAngles = 1200;
  double greatest = 0.0;
  for (int i = 0; i < kAngles; ++i) {
    const double phi = kTwoPi * i / kAngles;
    double x = 0.0;
    double y = 0.0;
    for (unsigned n = 1; n < 1001; n += 2) {
      const double sign = (n % taps == 1) ? 1.0 : (n % taps == taps - 1) ? -1.0 : 0.0;
      if (sign == 0.0) continue;
      x += std::cos(n * phi) / (static_cast<double>(n) * n);
      y += sign * std::sin(n * phi) / (static_cast<double>(n) * n);
    }
    greatest = std::max(greatest, std::abs(std::remainder(std::atan2(y, x) - phi, kTwoPi)));
  }
  return greatest;
}

TEST(TofNoise, SquareWavesWiggleByTheAliasedHarmonics) {
  const std::array<std::array<double, 2>, 3> known = {{{3, 0.0195}, {4, 0.0711}, {5, 0.0041}}};
  for (const auto& [taps, error_rad] : known) {
    const double measured = max_phase_error(static_cast<std::uint32_t>(taps));
    EXPECT_NEAR(measured / error_rad, 1.0, 0.011) << taps;  // 0.0041 has two digits
    EXPECT_NEAR(measured / max_alias_error(static_cast<unsigned>(taps)), 1.0, 0.01) << taps;
  }
}

TEST(TofNoise, SinesDoNotWiggle) {
  const TofCamera camera = plain_camera({80e6}, 4);
  const TofImages images = expose_scene(camera, 500, 1, [](std::uint32_t column, std::uint32_t) {
    return TofTarget{.range_m = 0.0037 * column};
  });
  const TofMeasurement measured = decode_tof(images, camera.decoder);
  for (std::uint32_t i = 1; i < 500; ++i) EXPECT_NEAR(measured.range_m[i], 0.0037 * i, 1e-6);
}

}  // namespace
}  // namespace glidar
