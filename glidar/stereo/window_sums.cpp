// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/stereo/window_sums.hpp>

#include <algorithm>

namespace glidar::stereo {

namespace {

constexpr std::size_t kSumBandRows = 32;

/// Sums of columns over the rows of the window.
struct ColumnSums {
  std::vector<std::uint32_t> step;
  std::vector<std::uint32_t> saturated;
};

/// Adds the row `count` times: 1, or -1 in unsigned arithmetic.
void add_image_row(const GreyImage& image, std::size_t y, std::uint32_t saturation_level,
                   std::uint32_t count, ColumnSums& sums) {
  const std::uint16_t* const level = image.level.data() + y * image.width;
  for (std::size_t x = 0; x < image.width; ++x) {
    sums.saturated[x] += level[x] >= saturation_level ? count : 0;
  }
  for (std::size_t x = 0; x + 1 < image.width; ++x) {
    const std::uint32_t step =
        level[x] > level[x + 1] ? level[x] - level[x + 1] : level[x + 1] - level[x];
    sums.step[x] += step * count;
  }
}

void sum_row(const ColumnSums& columns, std::size_t radius, std::size_t rows, std::size_t offset,
             WindowSums& windows) {
  const std::size_t width = columns.step.size();
  std::uint32_t step = 0;
  std::uint32_t saturated = 0;
  for (std::size_t x = 0; x < std::min(radius, width); ++x) {
    step += columns.step[x];
    saturated += columns.saturated[x];
  }
  for (std::size_t x = 0; x < width; ++x) {
    const std::size_t added = x + radius;
    if (added < width) {
      step += columns.step[added];
      saturated += columns.saturated[added];
    }
    if (x > radius) {
      step -= columns.step[x - radius - 1];
      saturated -= columns.saturated[x - radius - 1];
    }
    const std::size_t inside = std::min(added, width - 1) - (x > radius ? x - radius : 0) + 1;
    windows.step[offset + x] = step;
    windows.saturated[offset + x] = static_cast<std::uint16_t>(saturated);
    windows.pixels[offset + x] = static_cast<std::uint16_t>(inside * rows);
  }
}

void sum_band(const GreyImage& image, std::size_t radius, std::uint32_t saturation_level,
              std::size_t band, WindowSums& windows) {
  const std::size_t begin = band * kSumBandRows;
  const std::size_t end = std::min<std::size_t>(begin + kSumBandRows, image.height);
  ColumnSums columns = {std::vector<std::uint32_t>(image.width),
                        std::vector<std::uint32_t>(image.width)};
  std::size_t first = begin > radius ? begin - radius : 0;
  std::size_t next = first;
  for (std::size_t y = begin; y < end; ++y) {
    for (; next <= y + radius && next < image.height; ++next) {
      add_image_row(image, next, saturation_level, 1, columns);
    }
    for (; first + radius < y; ++first) {
      add_image_row(image, first, saturation_level, ~0U, columns);
    }
    sum_row(columns, radius, next - first, y * image.width, windows);
  }
}

}  // namespace

WindowSums sum_windows(const GreyImage& image, std::uint32_t radius, std::uint32_t saturation_level,
                       ThreadPool* pool) {
  WindowSums windows;
  const std::size_t count = std::size_t{image.width} * image.height;
  windows.step.resize(count);
  windows.saturated.resize(count);
  windows.pixels.resize(count);
  const auto sum = [&](std::size_t begin, std::size_t end) {
    for (std::size_t band = begin; band < end; ++band) {
      sum_band(image, radius, saturation_level, band, windows);
    }
  };
  const std::size_t bands = (image.height + kSumBandRows - 1) / kSumBandRows;
  if (pool == nullptr) {
    sum(0, bands);
  } else {
    pool->parallel_for(bands, 1, sum);
  }
  return windows;
}

}  // namespace glidar::stereo
