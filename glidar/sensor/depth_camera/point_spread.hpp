// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/thread_pool.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// Weights of the rays around a pixel, in one direction: a Gaussian of blur_px about each of the
/// pixel's sub_rays rays, of sum 1, symmetric. Entry k belongs to ray k - radius, counted from the
/// first ray of the pixel; radius is (size - sub_rays) / 2.
std::vector<double> point_spread_weights(std::uint32_t sub_rays, double blur_px);

/// Size of an image of pixels.
struct ImageSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

/// Averages an image of sub_rays x sub_rays rays per pixel (rows from the top) to pixels, with
/// these weights along both axes. Beyond the edge the last ray is repeated. Sums are in a fixed
/// order.
void average_rays(std::span<const float> rays, std::uint32_t sub_rays,
                  std::span<const double> weights, const ImageSize& size, ThreadPool& threads,
                  std::vector<float>& pixels);

}  // namespace glidar
