// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace glidar {

class FieldVisitor;

/// Which pixels of a window are compared (Zabih and Woodfill 1994): each with the centre, or each
/// with the one on the other side of the centre.
enum class StereoCensus : std::uint8_t { window_9x9, window_7x7, symmetric_7x7 };

/// How the minimum between three summed costs is found: a V of equal slopes (equiangular), a
/// parabola, or the integer disparity.
enum class StereoSubpixel : std::uint8_t { v_shape, parabola, none };

/// Options of match_stereo().
struct StereoOptions {
  std::uint32_t min_disparity_px = 0;
  std::uint32_t disparities = 128;  ///< searched, from min_disparity_px
  StereoCensus census = StereoCensus::window_7x7;
  std::uint32_t box_px = 5;  ///< odd side of the window over which costs are summed
  std::uint32_t paths = 8;   ///< 4 or 8
  double p1 = 4.0;           ///< cost of a step of 1 px along a path, bits per pixel of the box
  double p2 = 16.0;          ///< cost of a larger step, bits per pixel of the box; at least p1
  StereoSubpixel subpixel = StereoSubpixel::v_shape;
  double a_factor = 0.04;                 ///< px; adds a_factor sin(2 pi fraction)
  std::uint32_t uniqueness_percent = 15;  ///< 0: no test
  std::uint32_t left_right_px = 1;        ///< greatest difference of both views
  bool has_left_right_test = true;
  double min_texture = 0.5;  ///< mean grey-level step between neighbours; 0: no test
  std::uint32_t saturation_level =
      0;  ///< grey level from which pixels are saturated; 0: the greatest of the pixel type
  std::uint32_t steps_per_px = 32;  ///< disparities are multiples of 1 / this; 0: not rounded
};

/// Shows every option with its bounds and default to a visitor.
void describe(StereoOptions& options, FieldVisitor& visitor);

/// Number of bits of a census, and pixels from its centre to its edge.
std::uint32_t census_bits(StereoCensus census);
std::uint32_t census_radius_px(StereoCensus census);

/// Columns from the centre of a census window plus box to its edge.
std::uint32_t window_radius_px(const StereoOptions& options);

/// The penalties times the area of the box, rounded: the integers that path costs use.
std::int32_t penalty_p1(const StereoOptions& options);
std::int32_t penalty_p2(const StereoOptions& options);

/// Throws Error naming the first option that is not allowed.
void validate(const StereoOptions& options);

}  // namespace glidar
