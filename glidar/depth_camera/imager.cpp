// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/imager.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/distributions.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/math/simd.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glidar {

void describe(AmbientLight& light, FieldVisitor& visitor) {
  visitor.number({"ambient_w_per_m2",
                  "irradiance of every surface by light from all sides, within the passband, W/m²"},
                 kLightPowerRule, light.ambient_w_per_m2);
  visitor.number(
      {"sun_w_per_m2", "irradiance of a surface that faces the sun, within the passband, W/m²"},
      kLightPowerRule, light.sun_w_per_m2);
  Eigen::Vector3d direction = light.sun_direction;
  if (visitor.vector(
          {"sun_direction", "towards the sun, in the world frame", kNoUnit, false, "[0, 0, 1]"},
          {-1e6, 1e6, false, "a number from -1e6 to 1e6"}, true, direction)) {
    light.sun_direction = direction;
  }
  if (visitor.is_reading() && !(light.sun_direction.norm() > 0.0)) {
    visitor.reject("sun_direction", "a vector without direction", "a vector that is not zero");
  }
}

namespace {

constexpr double kPlanckConstant = 6.62607015e-34;  // in J s, exact
/// More than all full wells; in min(kMaxMean_e, light) also the value for light of NaN.
constexpr double kMaxMean_e = 1e300;
constexpr FieldUnit kUnitMillisecond = {"ms", 1e-3};

double greatest_level(const Imager& imager) {
  return static_cast<double>((1U << imager.bits) - 1U);
}

/// The mean of min(1, light x share) over all pixels, in a fixed order.
double mean_level(const ElectronRates& rates, double share_per_electron) {
  double sum = 0.0;
  for (std::size_t row = 0; row < rates.height; ++row) {
    double row_sum = 0.0;
    for (std::size_t i = row * rates.width; i < (row + 1) * rates.width; ++i) {
      const double electrons = double{rates.projector[i]} + double{rates.ambient[i]};
      row_sum += std::min(1.0, electrons * share_per_electron);
    }
    sum += row_sum;
  }
  return sum / (static_cast<double>(rates.width) * static_cast<double>(rates.height));
}

}  // namespace

void describe(AutoExposure& exposure, FieldVisitor& visitor) {
  visitor.number({"target", "mean grey level as a share of the greatest"},
                 {0.0, 1.0, true, "a number above 0 and below 1"}, exposure.target);
  visitor.number({"max_time_ms", "longest exposure", kUnitMillisecond}, kAboveZero,
                 exposure.max_time_s);
  visitor.number({"max_gain", "greatest gain, once the exposure is the longest"},
                 {1.0, 1e6, false, "a number from 1 to 1e6"}, exposure.max_gain);
}

void describe(Imager& imager, FieldVisitor& visitor) {
  visitor.number(
      {"focal_length_mm", "of the lens; a pixel's side is this over `fx`", kUnitMillimetre},
      kAboveZero, imager.focal_length_m);
  visitor.number({"f_number", "of the lens"}, {0.5, 100.0, false, "a number from 0.5 to 100"},
                 imager.f_number);
  visitor.number({"quantum_efficiency", "electrons per photon that enters the lens"}, kZeroToOne,
                 imager.quantum_efficiency);
  visitor.number({"blur_px", "standard deviation of the point spread", kUnitPixel},
                 {0.0, 20.0, false, "pixels from 0 to 20"}, imager.blur_px);
  visitor.number({"full_well_e", "electrons that saturate a pixel; the greatest level at gain 1"},
                 kAboveZero, imager.full_well_e);
  visitor.number({"read_noise_e", "standard deviation of the read noise, electrons"}, kFromZero,
                 imager.read_noise_e);
  visitor.whole_number({"bits", "of grey levels"}, {8, 16}, imager.bits);
  visitor.number({"exposure_ms", "exposure time; 0: automatic", kUnitMillisecond}, kFromZero,
                 imager.exposure_s);
  visitor.number({"gain", "with a fixed exposure"}, {1.0, 1e6, false, "a number from 1 to 1e6"},
                 imager.gain);
  visit_object(visitor, {"auto_exposure", "with `exposure_ms: 0`"}, imager.auto_exposure);
}

double electron_rate_per_radiance(const Imager& imager, double focal_length_px,
                                  double wavelength_m) {
  const double side_m = imager.focal_length_m / focal_length_px;
  const double power_w =
      std::numbers::pi / (4.0 * imager.f_number * imager.f_number) * side_m * side_m;
  return power_w * imager.quantum_efficiency * wavelength_m / (kPlanckConstant * kLight_m_per_s);
}

Exposure find_exposure(const Imager& imager, const ElectronRates& rates) {
  if (imager.exposure_s > 0.0) return {imager.exposure_s, imager.gain};
  const AutoExposure& automatic = imager.auto_exposure;
  double low = 0.0;
  double high = automatic.max_time_s * automatic.max_gain;  // time times gain
  if (mean_level(rates, high / imager.full_well_e) > automatic.target) {
    constexpr int kHalvings = 24;  // to 6e-8 of the longest
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      const bool is_too_bright = mean_level(rates, middle / imager.full_well_e) > automatic.target;
      (is_too_bright ? high : low) = middle;
    }
  }
  if (high <= automatic.max_time_s) return {high, 1.0};
  return {automatic.max_time_s, high / automatic.max_time_s};
}

double levels_per_electron(const Imager& imager, const Exposure& exposure) {
  return exposure.gain * greatest_level(imager) / imager.full_well_e;
}

PixelReading read_pixel(const Imager& imager, double levels_per_electron, double speckle_contrast,
                        const PixelLight& light, RngKey key) {
  PixelReading reading;
  const RandomWords words = random_words(key);
  const std::array<double, 4> normal = normals(words);
  ++key.block;
  const double poisson_uniform = uniform(random_words(key)[0]);
  ++key.block;
  if (light.projector_e > 0.0) reading.speckle = sample_gamma(speckle_contrast, key);
  const double mean_e = std::min(kMaxMean_e, light.projector_e * reading.speckle + light.ambient_e);
  reading.electrons =
      std::min(sample_poisson(mean_e, poisson_uniform, normal[0]), imager.full_well_e);
  reading.read_noise_e = imager.read_noise_e * normal[2];
  const double level = levels_per_electron * (reading.electrons + reading.read_noise_e);
  // max() with 0 first also turns NaN, of an infinite gain without electrons, into 0.
  reading.level = static_cast<std::uint16_t>(
      std::min(std::max(0.0, std::floor(level + 0.5)), greatest_level(imager)));
  return reading;
}

namespace {

constexpr double kBlurReach = 4.0;  // standard deviations: 6e-5 of the light is beyond
constexpr std::size_t kRowsPerTask = 8;

std::ptrdiff_t clamped(std::ptrdiff_t index, std::size_t count) {
  return std::clamp<std::ptrdiff_t>(index, 0, static_cast<std::ptrdiff_t>(count) - 1);
}

/// sum[i] += weight * row[i].
GLIDAR_SIMD void add_row(double weight, const float* row, std::size_t count, double* sum) {
  for (std::size_t i = 0; i < count; ++i) sum[i] += weight * static_cast<double>(row[i]);
}

/// A row of rays around the edges of which the first and the last ray are repeated.
struct PaddedRow {
  std::size_t radius;
  std::vector<double> ray;

  PaddedRow(std::size_t rays, std::size_t padding) : radius(padding), ray(rays + 2 * padding) {}

  void repeat_edges() {
    std::fill_n(ray.begin(), radius, ray[radius]);
    std::fill_n(ray.end() - static_cast<std::ptrdiff_t>(radius), radius,
                ray[ray.size() - radius - 1]);
  }
};

/// Sums of the rows of rays around a pixel, of which `first_row` is the pixel's first, by weight.
void sum_rows(std::span<const float> rays, std::span<const double> weights, std::size_t first_row,
              PaddedRow& padded) {
  const std::size_t columns = padded.ray.size() - 2 * padded.radius;
  const std::size_t rows = rays.size() / columns;
  double* const sums = padded.ray.data() + padded.radius;
  std::fill_n(sums, columns, 0.0);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const auto row =
        static_cast<std::ptrdiff_t>(first_row + k) - static_cast<std::ptrdiff_t>(padded.radius);
    add_row(weights[k], rays.data() + static_cast<std::size_t>(clamped(row, rows)) * columns,
            columns, sums);
  }
}

/// Pixels of a row from its sums of rows.
void sum_columns(const PaddedRow& padded, std::span<const double> weights, std::uint32_t sub_rays,
                 std::span<float> pixels) {
  for (std::size_t column = 0; column < pixels.size(); ++column) {
    const double* const around = padded.ray.data() + column * sub_rays;
    double sum = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * around[k];
    pixels[column] = static_cast<float>(sum);
  }
}

}  // namespace

std::vector<double> point_spread_weights(std::uint32_t sub_rays, double blur_px) {
  const auto radius = static_cast<std::ptrdiff_t>(std::ceil(kBlurReach * blur_px * sub_rays));
  std::vector<double> weights(static_cast<std::size_t>(2 * radius) + sub_rays, 0.0);
  const double sigma = blur_px * sub_rays;  // rays
  double sum = 0.0;
  for (std::ptrdiff_t offset = -radius; offset <= radius; ++offset) {
    const double x = sigma > 0.0 ? static_cast<double>(offset) / sigma : 0.0;
    const double weight = portable_exp(-0.5 * x * x);
    for (std::uint32_t ray = 0; ray < sub_rays; ++ray) {
      weights[static_cast<std::size_t>(offset + radius) + ray] += weight;
      sum += weight;
    }
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

void average_rays(std::span<const float> rays, std::uint32_t sub_rays,
                  std::span<const double> weights, const ImageSize& size, ThreadPool& threads,
                  std::vector<float>& pixels) {
  const std::size_t columns = std::size_t{size.width} * sub_rays;
  const std::size_t radius = (weights.size() - sub_rays) / 2;
  pixels.resize(std::size_t{size.width} * size.height);
  threads.parallel_for(size.height, kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    PaddedRow padded(columns, radius);
    for (std::size_t row = begin; row < end; ++row) {
      sum_rows(rays, weights, row * sub_rays, padded);
      padded.repeat_edges();
      sum_columns(padded, weights, sub_rays, {pixels.data() + row * size.width, size.width});
    }
  });
}

}  // namespace glidar
