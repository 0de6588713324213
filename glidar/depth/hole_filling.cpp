// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth/hole_filling.hpp>

#include <algorithm>
#include <array>

namespace glidar::depth {
namespace {

/// The pixels above, above on the left, on the left, below on the left and below.
template <class Value>
std::array<Value, 5> neighbours(const Value* pixel, std::size_t width) {
  return {pixel[-static_cast<std::ptrdiff_t>(width)],
          pixel[-static_cast<std::ptrdiff_t>(width) - 1], pixel[-1], pixel[width - 1],
          pixel[width]};
}

template <class Value>
Value farthest(const std::array<Value, 5>& around) {
  return *std::max_element(around.begin(), around.end());
}

/// As in librealsense, a hole above means that there is none.
template <class Value>
Value nearest(const std::array<Value, 5>& around) {
  Value least = around.front();
  for (const Value value : around) {
    if (value != Value{} && value < least) least = value;
  }
  return least;
}

template <class Value>
void fill_from_left(std::size_t width, std::vector<Value>& values) {
  for (std::size_t row = 0; row < values.size(); row += width) {
    for (std::size_t i = row + 1; i < row + width; ++i) {
      if (values[i] == Value{}) values[i] = values[i - 1];
    }
  }
}

/// All but the first column, the first row and the last row.
template <class Value, class Select>
void fill_from_around(const FilterImage& image, std::vector<Value>& values, const Select& select) {
  for (std::size_t y = 1; y + 1 < image.height; ++y) {
    for (std::size_t x = 1; x < image.width; ++x) {
      Value& value = values[y * image.width + x];
      if (value == Value{}) value = select(neighbours(&value, image.width));
    }
  }
}

template <class Value>
void fill(HoleSource source, const FilterImage& image, std::vector<Value>& values) {
  if (source == HoleSource::left) return fill_from_left(image.width, values);
  if (source == HoleSource::farthest) {
    return fill_from_around(image, values, [](const auto& a) { return farthest(a); });
  }
  fill_from_around(image, values, [](const auto& a) { return nearest(a); });
}

}  // namespace

void apply(const HoleFillingFilter& filter, FilterImage& image) {
  std::visit([&](auto& values) { fill(filter.source, image, values); }, image.values);
}

}  // namespace glidar::depth
