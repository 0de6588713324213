// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/depth_camera/point_spread.hpp>

#include <glidar/math/elementary.hpp>
#include <glidar/math/simd.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
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
