// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/imager.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace glidar {
namespace {

constexpr std::uint32_t kPixels = 160000;

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
};

/// Mean and variance of value(pixel) over many pixels.
template <class Value>
Moments moments_of(const Value& value) {
  double sum = 0.0;
  double squares = 0.0;
  for (std::uint32_t i = 0; i < kPixels; ++i) {
    const double x = value(i);
    sum += x;
    squares += x * x;
  }
  const double mean = sum / kPixels;
  return {mean, squares / kPixels - mean * mean};
}

RngKey pixel_key(std::uint32_t pixel) {
  return {.seed = 3, .beam = pixel, .purpose = Purpose::left_image};
}

Imager quiet_imager() {
  Imager imager;
  imager.read_noise_e = 0.0;
  imager.bits = 16;
  return imager;
}

// The photon transfer curve: shot noise alone gives variance / mean = gain. The statistical error
// of 160,000 pixels is 0.35 %.
TEST(Imager, HasAVarianceOverMeanEqualToItsGain) {
  const Imager imager = quiet_imager();
  for (const double mean_e : {5.0, 50.0, 3000.0}) {
    const double gain = levels_per_electron(imager, {.time_s = 1.0, .gain = 1.0});
    const Moments level = moments_of([&](std::uint32_t i) {
      return read_pixel(imager, gain, 0.0, {.ambient_e = mean_e}, pixel_key(i)).level;
    });
    EXPECT_NEAR(level.mean, gain * mean_e, 0.01 * gain * mean_e) << mean_e;
    EXPECT_NEAR((level.variance - 1.0 / 12.0) / level.mean, gain, 0.01 * gain) << mean_e;
  }
}

TEST(Imager, ReadsTheGreatestLevelForLightBeyondAllNumbers) {
  const Imager imager = quiet_imager();
  const double infinity = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < 16; ++i) {
    const PixelLight light = {.projector_e = infinity};
    EXPECT_EQ(read_pixel(imager, 1.0, 0.0, light, pixel_key(i)).electrons, imager.full_well_e) << i;
    EXPECT_EQ(read_pixel(imager, infinity, 0.0, {}, pixel_key(i)).level, 0U) << i;
  }
}

TEST(Imager, AddsReadNoiseOfItsStandardDeviation) {
  Imager imager = quiet_imager();
  imager.read_noise_e = 40.0;
  const Moments noise = moments_of([&](std::uint32_t i) {
    return read_pixel(imager, 1.0, 0.0, {.ambient_e = 400.0}, pixel_key(i)).level;
  });
  const double variance = 400.0 + 40.0 * 40.0 + 1.0 / 12.0;
  EXPECT_NEAR(noise.variance, variance, 0.01 * variance);
}

TEST(Imager, AppliesSpeckleToTheProjectorsLightAlone) {
  const Imager imager = quiet_imager();
  const PixelLight ambient{.ambient_e = 1000.0};
  EXPECT_EQ(read_pixel(imager, 1.0, 0.5, ambient, pixel_key(1)).speckle, 1.0);
  const PixelLight dots{.projector_e = 1000.0};
  EXPECT_NE(read_pixel(imager, 1.0, 0.5, dots, pixel_key(1)).speckle, 1.0);
}

TEST(Imager, ClipsAtTheFullWellAndTheGreatestLevel) {
  Imager imager = quiet_imager();
  imager.bits = 8;
  const PixelReading bright =
      read_pixel(imager, levels_per_electron(imager, {1.0, 1.0}), 0.0, {.ambient_e = 1e6}, {});
  EXPECT_EQ(bright.electrons, imager.full_well_e);
  EXPECT_EQ(bright.level, 255);
  imager.read_noise_e = 1e4;
  std::uint16_t least = 255;
  for (std::uint32_t i = 0; i < 100; ++i) {
    least = std::min(least, read_pixel(imager, 1.0, 0.0, {}, pixel_key(i)).level);
  }
  EXPECT_EQ(least, 0) << "levels below 0 are 0";
}

// B = pi L / (4 N²), photons of the energy h c / lambda: 3 um, f/2, 850 nm, half of the photons.
TEST(Imager, ReceivesTheElectronsOfTheCameraEquation) {
  Imager imager;
  imager.focal_length_m = 0.003;
  imager.f_number = 2.0;
  imager.quantum_efficiency = 0.5;
  const double irradiance = std::numbers::pi / 16.0;        // of L = 1
  const double photons = irradiance * 9e-12 / 2.33699e-19;  // of the energy at 850 nm
  EXPECT_NEAR(electron_rate_per_radiance(imager, 1000.0, 850e-9), 0.5 * photons, 1e-5 * photons);
}

ElectronRates rates_of(float projector, float ambient) {
  return {.width = 3,
          .height = 2,
          .projector = std::vector<float>(6, projector),
          .ambient = std::vector<float>(6, ambient)};
}

TEST(Exposure, GivesTheTargetLevelWithTimeBeforeGain) {
  Imager imager;
  const double target_e = imager.auto_exposure.target * imager.full_well_e;
  const Exposure bright = find_exposure(imager, rates_of(2e5F, 3e5F));
  EXPECT_NEAR(bright.time_s, target_e / 5e5, 1e-6 * imager.auto_exposure.max_time_s * 16.0);
  EXPECT_EQ(bright.gain, 1.0);
  const Exposure dim = find_exposure(imager, rates_of(1e4F, 1e4F));
  EXPECT_EQ(dim.time_s, imager.auto_exposure.max_time_s);
  EXPECT_NEAR(dim.gain * dim.time_s, target_e / 2e4, 1e-6);
  const Exposure dark = find_exposure(imager, rates_of(0.0F, 1.0F));
  EXPECT_DOUBLE_EQ(dark.gain, imager.auto_exposure.max_gain);
}

TEST(Exposure, IsTheFixedOneWhereItIsSet) {
  Imager imager;
  imager.exposure_s = 0.004;
  imager.gain = 2.0;
  const Exposure exposure = find_exposure(imager, rates_of(1e9F, 0.0F));
  EXPECT_EQ(exposure.time_s, 0.004);
  EXPECT_EQ(exposure.gain, 2.0);
}

TEST(PointSpread, HasSymmetricWeightsOfSumOne) {
  for (const std::uint32_t sub_rays : {1U, 2U, 3U, 5U}) {
    const std::vector<double> weights = point_spread_weights(sub_rays, 0.6);
    EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1.0, 1e-14);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      EXPECT_NEAR(weights[k], weights[weights.size() - 1 - k], 1e-16) << sub_rays << ' ' << k;
    }
  }
}

// Variances add: the Gaussian's, and that of the n rays of a pixel, (1 - 1/n²) / 12.
TEST(PointSpread, HasTheVarianceOfGaussianAndPixel) {
  constexpr std::uint32_t kRays = 4;
  const std::vector<double> weights = point_spread_weights(kRays, 0.6);
  const double middle = 0.5 * static_cast<double>(weights.size() - 1);
  double variance = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const double offset_px = (static_cast<double>(k) - middle) / kRays;
    variance += weights[k] * offset_px * offset_px;
  }
  EXPECT_NEAR(variance, 0.36 + (1.0 - 1.0 / 16.0) / 12.0, 1e-3);
}

TEST(PointSpread, WithoutBlurIsTheMeanOfThePixelsRays) {
  const std::vector<double> weights = point_spread_weights(2, 0.0);
  std::vector<float> pixels;
  ThreadPool threads(1);
  const std::vector<float> rays = {1, 2, 3, 4, 5, 6, 7, 8};  // two pixels in a row
  average_rays(rays, 2, weights, {2, 1}, threads, pixels);
  EXPECT_EQ(pixels, (std::vector<float>{3.5F, 5.5F}));
}

TEST(PointSpread, KeepsAnEvenImageUpToItsEdgesForAnyThreads) {
  const std::vector<double> weights = point_spread_weights(3, 0.8);
  const std::vector<float> rays(30U * 3U * 20U * 3U, 0.7F);
  for (const unsigned count : {1U, 2U, 8U}) {
    ThreadPool threads(count);
    std::vector<float> pixels;
    average_rays(rays, 3, weights, {30, 20}, threads, pixels);
    ASSERT_EQ(pixels.size(), 600U);
    for (const float pixel : pixels) ASSERT_FLOAT_EQ(pixel, 0.7F);
  }
}

}  // namespace

}  // namespace glidar
