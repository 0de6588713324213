// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar {

/// Grey levels row by row from the top, without padding: width x height.
struct GreyImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t max_level = 255;  ///< greatest that the pixel type can store
  std::vector<std::uint16_t> level = {};
};

/// Raw images of a continuous-wave camera: the difference of a pixel's two wells, or the value of
/// one, for every phase step of every frequency. A step k of N measures A cos(phi - 2 pi k / N)
/// plus a constant, where phi = 4 pi f R / c grows with the range.
struct TofImages {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t frequencies = 0;
  std::uint32_t taps = 0;  ///< N
  /// frequencies x taps x height x width, row 0 on top, in any unit; infinite: saturated.
  std::vector<float> level = {};
};

/// Number of pixels of an image.
inline std::size_t pixel_count(const TofImages& images) {
  return std::size_t{images.width} * images.height;
}

/// Removes the images; their memory is kept for others.
inline void clear(TofImages& images) {
  images.width = images.height = images.frequencies = images.taps = 0;
  images.level.clear();
}

/// Index in `level` of the first pixel of a phase step.
inline std::size_t tap_offset(const TofImages& images, std::size_t frequency, std::size_t tap) {
  return (frequency * images.taps + tap) * pixel_count(images);
}

}  // namespace glidar
