// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/raw_images.hpp>
#include <glidar/depth_camera/time_of_flight.hpp>

#include <cstdint>
#include <functional>

namespace glidar::testing {

/// A camera without noise: one electron per level, contrast 1.
TofCamera plain_camera(std::vector<double> frequencies_hz, std::uint32_t taps);

/// What the pixel (column, row) sees.
struct TofTarget {
  double range_m = 1.0;
  double electrons = 1000.0;
  double background = 0.0;
};

using TofScene = std::function<TofTarget(std::uint32_t column, std::uint32_t row)>;

/// Raw images of one target for each pixel, without noise or with that of a seed.
TofImages expose_scene(const TofCamera& camera, std::uint32_t width, std::uint32_t height,
                       const TofScene& scene);
TofImages expose_noisy_scene(const TofCamera& camera, std::uint32_t width, std::uint32_t height,
                             const TofScene& scene, std::uint64_t seed);

}  // namespace glidar::testing
