// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/optics/pinhole.hpp>
#include <glidar/structured_light/fringe_patterns.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace glidar {

class FieldVisitor;

/// The light of a projector of images.
struct ProjectorLight {
  double power_w = 0.5;           ///< optical, of an image of the greatest level
  double gamma = 1.0;             ///< light of a level, shares of the greatest: level^gamma
  double blur_px = 0.5;           ///< standard deviation of its Gaussian point spread, own pixels
  double speckle_contrast = 0.0;  ///< standard deviation over mean; independent in each image
};

/// Keys of `light` of structured-light cameras.
void describe(ProjectorLight& light, FieldVisitor& visitor);

/// The radiant intensity of an image of the greatest level, W/sr, the same in all directions of the
/// image: the power over the solid angle of the image without lens distortion. The part of the
/// plane z = 1 from the axis to (x, y) covers atan(x y / sqrt(1 + x^2 + y^2)) (Khadjavi,
/// Calculation of solid angle subtended by rectangular apertures, J. Opt. Soc. Am. 58, 1968).
double white_intensity_w_per_sr(const Pinhole& projector, double power_w);

/// Light of pattern i at the centres of the projector's pixels along the encoded axis, as a share
/// of that of the greatest level: 8-bit levels, the projector's gamma, then its point spread.
std::vector<float> projected_line(const FringePatterns& patterns, const ProjectorLight& light,
                                  std::size_t image);

/// Light at a coordinate, whole numbers are centres of pixels: linear between them, and beyond the
/// outer centres that of the outer pixel.
inline float light_at(std::span<const float> line, float coordinate_px) {
  const float place = std::clamp(coordinate_px, 0.0F, static_cast<float>(line.size() - 1));
  const auto left = static_cast<std::size_t>(place);
  const std::size_t right = std::min(left + 1, line.size() - 1);
  return line[left] + (place - static_cast<float>(left)) * (line[right] - line[left]);
}

}  // namespace glidar
