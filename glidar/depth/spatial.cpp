// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth/spatial.hpp>

#include <cmath>
#include <cstdlib>
#include <utility>

namespace glidar::depth {
namespace {

/// From this many pixels on, a hole along a row is not filled. Unlimited is 255 in librealsense.
std::size_t hole_limit(HoleWidth width) {
  if (width == HoleWidth::none) return 0;
  if (width == HoleWidth::unlimited) return 255;
  return std::size_t{1} << static_cast<unsigned>(width);
}

struct Smoothing {
  float alpha;
  float rest;  ///< 1 - alpha
  float delta;
  std::size_t hole_limit;
};

/// The moving average along a line of disparities.
struct DisparityAverage {
  float last = 0.0F;  ///< the value before, as it came in
  float average = 0.0F;
};

float smooth_disparity(const Smoothing& smoothing, float value, DisparityAverage& line) {
  const float last = std::exchange(line.last, value);
  if (!(value > 0.0F)) return value;
  const float step = last - value;
  const bool continues = last > 0.0F && step < smoothing.delta && step > -smoothing.delta;
  line.average = continues ? value * smoothing.alpha + line.average * smoothing.rest : value;
  return line.average;
}

void smooth_rows(const Smoothing& smoothing, std::size_t width, std::vector<float>& values) {
  for (std::size_t row = 0; row < values.size(); row += width) {
    DisparityAverage forwards;
    for (std::size_t x = 0; x < width; ++x) {
      values[row + x] = smooth_disparity(smoothing, values[row + x], forwards);
    }
    DisparityAverage backwards;
    for (std::size_t x = width; x-- > 0;) {
      values[row + x] = smooth_disparity(smoothing, values[row + x], backwards);
    }
  }
}

void smooth_columns(const Smoothing& smoothing, std::size_t width, std::vector<float>& values) {
  std::vector<DisparityAverage> down(width);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = smooth_disparity(smoothing, values[i], down[i % width]);
  }
  std::vector<DisparityAverage> up(width);
  for (std::size_t row = values.size(); row > 0;) {
    row -= width;
    for (std::size_t x = 0; x < width; ++x) {
      values[row + x] = smooth_disparity(smoothing, values[row + x], up[x]);
    }
  }
}

/// Copies `neighbour` into a hole that is not wider than the limit; `run` counts its pixels.
void fill_pixel(std::size_t limit, float neighbour, std::size_t& run, float& value) {
  if (value != 0.0F) {
    run = 0;
  } else if (++run < limit) {
    value = neighbour;
  }
}

/// Fills from the left, then from the right. As in librealsense, the right neighbour of the last
/// pixel of a row is the first one of the next row, and the first pixel is not filled.
void fill_rows(std::size_t limit, std::size_t width, std::vector<float>& values) {
  for (std::size_t row = 0; row < values.size(); row += width) {
    std::size_t run = 0;
    for (std::size_t i = row + 1; i < row + width; ++i) {
      fill_pixel(limit, values[i - 1], run, values[i]);
    }
    run = 0;
    for (std::size_t i = row + width - 1; i > row; --i) {
      const float neighbour = i + 1 < values.size() ? values[i + 1] : 0.0F;
      fill_pixel(limit, neighbour, run, values[i]);
    }
  }
}

void smooth(const SpatialFilter& filter, const Smoothing& smoothing, std::size_t width,
            std::vector<float>& values) {
  for (std::uint32_t pass = 0; pass < filter.magnitude; ++pass) {
    smooth_rows(smoothing, width, values);
    smooth_columns(smoothing, width, values);
  }
  if (smoothing.hole_limit > 0) fill_rows(smoothing.hole_limit, width, values);
}

using Depths = std::vector<std::uint16_t>;

std::uint16_t mix_depths(const Smoothing& smoothing, std::uint16_t value, std::uint16_t last) {
  const float mixed =
      static_cast<float>(value) * smoothing.alpha + static_cast<float>(last) * smoothing.rest;
  return static_cast<std::uint16_t>(std::floor(mixed + 0.5F));
}

float step_between(std::uint16_t a, std::uint16_t b) {
  return static_cast<float>(std::abs(int{a} - int{b}));
}

/// Mixes `value` with the pixel before it in the row, or fills it. Values of less than `least` are
/// holes. Returns the new value.
std::uint16_t smooth_row_depth(const Smoothing& smoothing, std::uint16_t least, std::uint16_t last,
                               std::uint16_t value, std::size_t& run) {
  if (last == 0) return value;
  if (value >= least) {
    run = 0;
    if (step_between(value, last) > smoothing.delta) return value;
    return mix_depths(smoothing, value, last);
  }
  return smoothing.hole_limit > 0 && ++run < smoothing.hole_limit ? last : value;
}

/// As in librealsense, the last column is not changed forwards, and depths of 1 are holes
/// backwards.
void smooth_rows(const Smoothing& smoothing, std::size_t width, Depths& values) {
  for (std::size_t row = 0; row < values.size(); row += width) {
    std::size_t run = 0;
    for (std::size_t i = row + 1; i + 1 < row + width; ++i) {
      values[i] = smooth_row_depth(smoothing, 1, values[i - 1], values[i], run);
    }
    run = 0;
    for (std::size_t i = row + width - 1; i-- > row;) {
      values[i] = smooth_row_depth(smoothing, 2, values[i + 1], values[i], run);
    }
  }
}

/// As in librealsense, holes take part downwards if the depth beside them is below delta.
void smooth_columns(const Smoothing& smoothing, std::size_t width, Depths& values) {
  for (std::size_t i = width; i < values.size(); ++i) {
    const std::uint16_t above = values[i - width];
    if (step_between(above, values[i]) < smoothing.delta) {
      values[i] = mix_depths(smoothing, values[i], above);
    }
  }
  for (std::size_t i = values.size() - width; i-- > 0;) {
    const std::uint16_t below = values[i + width];
    if (values[i] == 0 || below == 0) continue;
    if (step_between(below, values[i]) < smoothing.delta) {
      values[i] = mix_depths(smoothing, values[i], below);
    }
  }
}

void smooth(const SpatialFilter& filter, const Smoothing& smoothing, std::size_t width,
            Depths& values) {
  for (std::uint32_t pass = 0; pass < filter.magnitude; ++pass) {
    smooth_rows(smoothing, width, values);
    smooth_columns(smoothing, width, values);
  }
}

}  // namespace

void apply(const SpatialFilter& filter, FilterImage& image) {
  const auto alpha = static_cast<float>(filter.alpha);
  const Smoothing smoothing = {alpha, 1.0F - alpha, static_cast<float>(filter.delta),
                               hole_limit(filter.hole_filling)};
  std::visit([&](auto& values) { smooth(filter, smoothing, image.width, values); }, image.values);
}

}  // namespace glidar::depth
