// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth_camera/stereo.hpp>

#include <cstdint>
#include <functional>

namespace glidar::testing {

struct TestPair {
  GreyImage left;
  GreyImage right;
};

/// An image of one grey level.
GreyImage flat_image(std::uint32_t width, std::uint32_t height, std::uint16_t level);

/// Independent random grey levels.
GreyImage noise_image(std::uint32_t width, std::uint32_t height, std::uint32_t seed);

/// A right image of noise, and a left one in which every pixel is `disparity_px` further right.
TestPair shifted_noise(std::uint32_t width, std::uint32_t height, std::uint32_t disparity_px);

/// Smooth random dots (Gaussians of 0.9 px), drawn at exact positions: those of the left image are
/// `disparity_px(row)` px further right.
TestPair dot_pair(std::uint32_t width, std::uint32_t height,
                  const std::function<double(double row)>& disparity_px);

/// Dots on two planes: the columns from `begin` to `end` of the left image have the near disparity.
TestPair step_pair(std::uint32_t width, std::uint32_t height, std::uint32_t far_px,
                   std::uint32_t near_px, std::uint32_t begin, std::uint32_t end);

}  // namespace glidar::testing
