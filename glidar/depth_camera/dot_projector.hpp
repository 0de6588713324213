// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/raw_images.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace glidar {

class FieldVisitor;

/// A projector of infrared dots. Its axes are those of the camera. The pattern is on the plane
/// z = 1 before it: a picture, or generated dots (Gaussian, of different brightness, none nearer to
/// another than 0.7 of the mean spacing).
struct DotProjector {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< in the frame of the left camera
  double power_w = 0.3;                                ///< optical, of the whole pattern
  double fov_x_rad = 1.5708;      ///< angle that the pattern covers along the width, symmetric
  double fov_y_rad = 1.0996;      ///< along the height
  std::uint32_t dots = 22000;     ///< of the generated pattern; fewer if no place is left
  double dot_width_rad = 0.0035;  ///< full width of a dot at half maximum, on the axis
  double dot_contrast = 0.6;      ///< standard deviation over mean of the dots' brightness
  std::uint32_t pattern_seed = 1;
  std::string picture = {};       ///< file of a picture in place of generated dots; empty: none
  GreyImage pattern = {};         ///< content of that file: levels are linear intensities
  double speckle_contrast = 0.6;  ///< standard deviation over mean; changes with every frame
};

/// Keys of `projector` of depth cameras. Readers in io load `pattern`.
void describe(DotProjector& projector, FieldVisitor& visitor);

/// The radiant intensity of a projector, as texels on the plane z = 1 before it.
struct IntensityMap {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  double left = 0.0;          ///< x of the left edge of texel 0
  double top = 0.0;           ///< y of the upper edge of row 0
  double texels_per_x = 0.0;  ///< texels per unit of x
  double texels_per_y = 0.0;
  std::vector<float> w_per_sr;  ///< width x height, row by row from the top (y down)
};

/// A generated dot.
struct Dot {
  Eigen::Vector2d centre;   ///< on the plane z = 1
  double brightness = 1.0;  ///< of mean 1, gamma distribution
};

/// Candidates in random places of the pattern, one after the other, are dots unless another one is
/// too near ("dart throwing": Cook, Stochastic sampling in computer graphics, ACM TOG 5(1), 1986).
std::vector<Dot> place_dots(const DotProjector& projector);

/// The pattern, scaled so that the integral over all directions is the power: a texel of the area
/// dA at the angle a from the axis covers the solid angle cos^3 a dA. Throws Error when there is no
/// light in the picture, or when the dots are too small for kMaxPatternTexels.
IntensityMap make_intensity_map(const DotProjector& projector);

inline constexpr std::size_t kMaxPatternTexels = std::size_t{1} << 26U;

/// Intensity in the direction of (x, y, 1), W/sr: linear between the centres of texels, 0 outside
/// the pattern.
inline double intensity_at(const IntensityMap& map, double x, double y) {
  const double u = (x - map.left) * map.texels_per_x - 0.5;
  const double v = (y - map.top) * map.texels_per_y - 0.5;
  if (!(u >= 0.0 && v >= 0.0 && u < map.width - 1.0 && v < map.height - 1.0)) return 0.0;
  const auto column = static_cast<std::size_t>(u);
  const auto row = static_cast<std::size_t>(v);
  const double right = u - static_cast<double>(column);
  const double below = v - static_cast<double>(row);
  const float* const texel = map.w_per_sr.data() + row * map.width + column;
  const double upper = texel[0] + right * (texel[1] - texel[0]);
  const double lower = texel[map.width] + right * (texel[map.width + 1] - texel[map.width]);
  return upper + below * (lower - upper);
}

}  // namespace glidar
