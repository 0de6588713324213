// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <depth_camera/test_pairs.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace glidar::testing {

namespace {

constexpr double kDotSigma_px = 0.9;
constexpr double kDotsPerPixel = 0.06;

std::uint32_t uniform_below(std::mt19937& words, std::uint32_t end) {
  return static_cast<std::uint32_t>(words()) % end;
}

double uniform_to(std::mt19937& words, double end) {
  return end * (static_cast<double>(words()) / 4294967296.0);
}

void add_dot(double column, double row, std::vector<double>& level, const GreyImage& image) {
  const int reach = 5;
  const int u = static_cast<int>(std::floor(column));
  const int v = static_cast<int>(std::floor(row));
  for (int y = std::max(v - reach, 0); y <= std::min(v + reach, static_cast<int>(image.height) - 1);
       ++y) {
    for (int x = std::max(u - reach, 0);
         x <= std::min(u + reach, static_cast<int>(image.width) - 1); ++x) {
      const double r2 = (x - column) * (x - column) + (y - row) * (y - row);
      level[static_cast<std::size_t>(y) * image.width + static_cast<std::size_t>(x)] +=
          150.0 * std::exp(-r2 / (2.0 * kDotSigma_px * kDotSigma_px));
    }
  }
}

void set_levels(const std::vector<double>& level, GreyImage& image) {
  image.level.resize(level.size());
  for (std::size_t i = 0; i < level.size(); ++i) {
    image.level[i] = static_cast<std::uint16_t>(std::lround(std::min(level[i], 255.0)));
  }
}

}  // namespace

GreyImage flat_image(std::uint32_t width, std::uint32_t height, std::uint16_t level) {
  return {width, height, 255, std::vector<std::uint16_t>(std::size_t{width} * height, level)};
}

GreyImage noise_image(std::uint32_t width, std::uint32_t height, std::uint32_t seed) {
  GreyImage image = flat_image(width, height, 0);
  std::mt19937 words(seed);
  for (std::uint16_t& level : image.level) {
    level = static_cast<std::uint16_t>(uniform_below(words, 255));
  }
  return image;
}

TestPair shifted_noise(std::uint32_t width, std::uint32_t height, std::uint32_t disparity_px) {
  TestPair pair = {noise_image(width, height, 1), noise_image(width, height, 2)};
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = disparity_px; x < width; ++x) {
      pair.left.level[y * width + x] = pair.right.level[y * width + x - disparity_px];
    }
  }
  return pair;
}

TestPair dot_pair(std::uint32_t width, std::uint32_t height,
                  const std::function<double(double row)>& disparity_px) {
  TestPair pair = {flat_image(width, height, 0), flat_image(width, height, 0)};
  std::vector<double> left(std::size_t{width} * height, 20.0);
  std::vector<double> right = left;
  std::mt19937 words(7);
  const double span = width + 200.0;
  const auto dots = static_cast<int>(kDotsPerPixel * span * height);
  for (int i = 0; i < dots; ++i) {
    const double column = uniform_to(words, span) - 150.0;
    const double row = uniform_to(words, height);
    add_dot(column, row, right, pair.right);
    add_dot(column + disparity_px(row), row, left, pair.left);
  }
  set_levels(left, pair.left);
  set_levels(right, pair.right);
  return pair;
}

TestPair step_pair(std::uint32_t width, std::uint32_t height, std::uint32_t far_px,
                   std::uint32_t near_px, std::uint32_t begin, std::uint32_t end) {
  TestPair pair = {noise_image(width, height, 3), noise_image(width, height, 4)};
  for (std::size_t y = 0; y < height; ++y) {
    std::uint16_t* const right = pair.right.level.data() + y * width;
    const std::uint16_t* const left = pair.left.level.data() + y * width;
    for (std::size_t x = far_px; x < width; ++x) right[x - far_px] = left[x];
    for (std::size_t x = begin; x < end; ++x) right[x - near_px] = left[x];  // hides the far plane
  }
  return pair;
}

}  // namespace glidar::testing
