// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth/conversion.hpp>

#include <cmath>
#include <utility>

namespace glidar::depth {
namespace {

constexpr float kStepsPerPixel = 32.0F;
constexpr float kDepthEnd = 65536.0F;  ///< above 16 bits

}  // namespace

/// In the units and order of librealsense: the baseline is in millimetres there.
float disparity_factor(double baseline_m, float focal_length_px, double unit_m) {
  const float baseline_mm = static_cast<float>(baseline_m * 1000.0);
  const float baseline = baseline_mm * 0.001F;
  return baseline * focal_length_px * kStepsPerPixel / static_cast<float>(unit_m);
}

void to_disparity(float factor, FilterImage& image) {
  const auto& depth = std::get<std::vector<std::uint16_t>>(image.values);
  std::vector<float> disparity(depth.size(), 0.0F);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] != 0) disparity[i] = factor / static_cast<float>(depth[i]);
  }
  image.values = std::move(disparity);
}

void to_depth(float factor, FilterImage& image) {
  const auto& disparity = std::get<std::vector<float>>(image.values);
  std::vector<std::uint16_t> depth(disparity.size(), 0);
  for (std::size_t i = 0; i < disparity.size(); ++i) {
    if (!std::isnormal(disparity[i])) continue;
    const float units = factor / disparity[i] + 0.5F;
    if (units < kDepthEnd) depth[i] = static_cast<std::uint16_t>(units);
  }
  image.values = std::move(depth);
}

void apply(const ThresholdFilter& filter, double unit_m, FilterImage& image) {
  const auto unit = static_cast<float>(unit_m);
  const auto min_m = static_cast<float>(filter.min_m);
  const auto max_m = static_cast<float>(filter.max_m);
  for (std::uint16_t& depth : std::get<std::vector<std::uint16_t>>(image.values)) {
    const float depth_m = unit * static_cast<float>(depth);
    if (!(depth_m >= min_m && depth_m <= max_m)) depth = 0;
  }
}

}  // namespace glidar::depth
