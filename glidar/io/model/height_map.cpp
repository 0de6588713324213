// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/height_map.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace glidar {
namespace {

constexpr double kFull = 255.0;

struct Slope {
  double x = 0.0;
  double y = 0.0;
};

class Heights {
 public:
  explicit Heights(const Texture& image) : image_(image) {}

  /// Rise per texel to the right and upwards.
  [[nodiscard]] Slope slope(std::size_t row, std::size_t column) const {
    const std::size_t right = (column + 1) % image_.width;
    const std::size_t left = (column + image_.width - 1) % image_.width;
    const std::size_t below = (row + 1) % image_.height;
    const std::size_t above = (row + image_.height - 1) % image_.height;
    return {(at(row, right) - at(row, left)) / 2.0, (at(above, column) - at(below, column)) / 2.0};
  }

 private:
  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return image_.texels[(row * image_.width + column) * image_.channels] / kFull;
  }

  const Texture& image_;
};

std::uint8_t coded(double component) {
  return static_cast<std::uint8_t>(std::lround((component + 1.0) / 2.0 * kFull));
}

double steepest(const Texture& image) {
  const Heights heights(image);
  double max_slope = 0.0;
  for (std::size_t row = 0; row < image.height; ++row) {
    for (std::size_t column = 0; column < image.width; ++column) {
      const Slope s = heights.slope(row, column);
      max_slope = std::max({max_slope, std::abs(s.x), std::abs(s.y)});
    }
  }
  return max_slope;
}

}  // namespace

HeightNormals normals_from_heights(const Texture& heights) {
  HeightNormals result;
  result.texture = {heights.name, heights.width, heights.height, 3, {}};
  const double max_slope = steepest(heights);
  const double gain = max_slope > 0.0 ? 1.0 / max_slope : 1.0;
  result.normal_scale = static_cast<float>(1.0 / gain);
  auto& texels = result.texture.texels;
  texels.reserve(std::size_t{heights.width} * heights.height * 3);
  const Heights field(heights);
  for (std::size_t row = 0; row < heights.height; ++row) {
    for (std::size_t column = 0; column < heights.width; ++column) {
      const Slope s = field.slope(row, column);
      const double x = -gain * s.x;
      const double y = -gain * s.y;
      const double length = std::sqrt(x * x + y * y + 1.0);
      texels.insert(texels.end(), {coded(x / length), coded(y / length), coded(1.0 / length)});
    }
  }
  return result;
}

bool looks_like_normal_map(const Texture& image) {
  if (image.channels < 3 || image.texels.empty()) return false;
  const std::size_t count = std::size_t{image.width} * image.height;
  std::uint64_t blue = 0;
  std::uint64_t colour = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* rgb = &image.texels[i * image.channels];
    blue += rgb[2];
    colour += static_cast<std::uint64_t>(std::abs(rgb[2] - rgb[0]) + std::abs(rgb[2] - rgb[1]));
  }
  constexpr std::uint64_t kBlue = 150;   // z of most normals is above 0.2
  constexpr std::uint64_t kColour = 40;  // flat (128, 128, 255) has 254, a grey image 0
  return blue > kBlue * count && colour > kColour * count;
}

}  // namespace glidar
