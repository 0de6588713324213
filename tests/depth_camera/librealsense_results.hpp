// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth_camera/depth_filters.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glidar::test {

/// Filters, and the result of librealsense for the last of kLibrealsenseImages images.
struct LibrealsenseResult {
  std::string name;
  std::vector<DepthFilter> filters;
  DepthImage last;
};

inline constexpr std::uint32_t kLibrealsenseImages = 9;
inline constexpr double kLibrealsenseFocalLength_px = 382.0;

/// Image k: two steps with noise and holes, by whole numbers alone.
DepthImage librealsense_input(std::uint32_t k);

/// Made by pyrealsense2 2.59.1 (Apache-2.0) with its software device, from the images of
/// librealsense_input(); unit 1 mm, baseline 50 mm.
std::vector<LibrealsenseResult> librealsense_results();

}  // namespace glidar::test
