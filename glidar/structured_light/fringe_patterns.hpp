// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/grey_image.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar {

class FieldVisitor;

/// Which coordinate of the projector the patterns encode: fringes are columns or rows.
enum class FringeAxis : std::uint8_t { columns, rows };

/// A sequence of images that a projector shows one after the other: phase-shifted fringes, then a
/// Gray code whose stripes are half a fringe wide, the coarsest first, each followed by its
/// inverse.
struct FringePatterns {
  std::uint32_t width = 1280;  ///< of the projector's image
  std::uint32_t height = 800;  ///< of it
  FringeAxis axis = FringeAxis::columns;
  std::uint32_t steps = 4;   ///< images of fringes; 0: Gray code alone
  double period_px = 32.0;   ///< of a fringe; stripes of the Gray code are half as wide
  bool has_inverses = true;  ///< of the images of the Gray code; true with steps 0
  double gamma = 1.0;        ///< of the projector, which the levels compensate: level^(1 / gamma)
  double min_level = 0.0;    ///< of the light, as a share of the greatest; 0 to below max_level
  double max_level = 1.0;
};

/// Keys of `patterns`, with bounds and defaults; width and height are those of the projector.
void describe(FringePatterns& patterns, FieldVisitor& visitor);

/// Throws Error naming the first value that is not allowed.
void validate(const FringePatterns& patterns);

/// The encoded coordinate of a pixel (column, row): 0 or 1.
inline int axis_index(const FringePatterns& patterns) {
  return patterns.axis == FringeAxis::columns ? 0 : 1;
}

/// Pixels of the projector along the encoded axis.
std::uint32_t encoded_size(const FringePatterns& patterns);

/// Images of the Gray code, without inverses.
std::uint32_t gray_code_bits(const FringePatterns& patterns);

/// Images of the sequence.
std::size_t image_count(const FringePatterns& patterns);

/// The number of the stripe of half a period in which a pixel is.
std::uint32_t stripe_of(const FringePatterns& patterns, std::uint32_t pixel);

/// The light of image i at pixel x along the encoded axis, as a share of the projector's greatest:
/// for fringes (1 + cos(2 pi ((x + 1/2) / period - i / steps))) / 2 from min_level to max_level.
double fringe_light(const FringePatterns& patterns, std::size_t image, std::uint32_t pixel);

/// The levels of image i of the sequence along the encoded axis, 0 to 255: the light with the
/// projector's gamma compensated, rounded.
std::vector<std::uint16_t> pattern_line(const FringePatterns& patterns, std::size_t image);

/// Image i of the sequence as the projector takes it, 8 bits, see pattern_line(). Throws Error
/// when there is no such image.
GreyImage make_pattern(const FringePatterns& patterns, std::size_t image);

}  // namespace glidar
