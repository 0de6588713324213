// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/optics/pinhole.hpp>

#include <cstddef>
#include <cstdint>

namespace glidar {

/// A camera with `sub_rays` x `sub_rays` pixels in place of each: the centre of each block is the
/// centre of a pixel. The distortion is the same.
Pinhole divide_pixels(const Pinhole& camera, std::uint32_t sub_rays);

/// Throws Error when an image has too many rays for the memory.
void check_sub_rays(const PinholeIntrinsics& image, std::uint32_t sub_rays);

/// The index of ray i of sub_rays^2 of a pixel, of a camera with this number of columns.
inline std::size_t ray_of_pixel(std::size_t columns, std::size_t sub_rays, std::size_t pixel,
                                std::size_t i) {
  const std::size_t row = pixel / columns * sub_rays + i / sub_rays;
  return row * columns * sub_rays + pixel % columns * sub_rays + i % sub_rays;
}

}  // namespace glidar
