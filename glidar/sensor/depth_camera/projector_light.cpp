// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/depth_camera/projector_light.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/sensor/depth_camera/light_power.hpp>
#include <glidar/sensor/depth_camera/point_spread.hpp>

#include <cmath>

namespace glidar {
namespace {

constexpr double kMaxGrey = 255.0;

/// Solid angle of the rectangle from the axis to (x, y) on the plane z = 1, with their signs.
double solid_angle_sr(double x, double y) {
  const double turns = atan2_turns(x * y, std::sqrt(1.0 + x * x + y * y));
  return kTwoPi * (turns > 0.5 ? turns - 1.0 : turns);
}

/// A line with its ends repeated, weighted.
std::vector<float> blurred(const std::vector<double>& line, double blur_px) {
  const std::vector<double> weights = point_spread_weights(1, blur_px);
  const auto radius = static_cast<std::ptrdiff_t>(weights.size() / 2);
  const std::ptrdiff_t last = static_cast<std::ptrdiff_t>(line.size()) - 1;
  std::vector<float> result;
  result.reserve(line.size());
  for (std::ptrdiff_t i = 0; i <= last; ++i) {
    double sum = 0.0;
    for (std::ptrdiff_t k = -radius; k <= radius; ++k) {
      const std::ptrdiff_t from = std::clamp<std::ptrdiff_t>(i + k, 0, last);
      sum += weights[static_cast<std::size_t>(k + radius)] * line[static_cast<std::size_t>(from)];
    }
    result.push_back(static_cast<float>(sum));
  }
  return result;
}

}  // namespace

void describe(ProjectorLight& light, FieldVisitor& visitor) {
  visitor.number({"power_w", "optical power of an image of the greatest level, W"}, kLightPowerRule,
                 light.power_w);
  visitor.number({"gamma",
                  "light of a level: level^gamma, both as shares of the greatest; `patterns.gamma` "
                  "compensates it"},
                 {0.1, 10.0, false, "a number from 0.1 to 10"}, light.gamma);
  visitor.number(
      {"blur_px", "standard deviation of its point spread, in pixels of the projector", kUnitPixel},
      {0.0, 20.0, false, "pixels from 0 to 20"}, light.blur_px);
  visitor.number({"speckle_contrast",
                  "standard deviation over mean of the light that speckle changes in every image"},
                 kZeroToOne, light.speckle_contrast);
}

double white_intensity_w_per_sr(const Pinhole& projector, double power_w) {
  const PinholeIntrinsics& k = projector.intrinsics;
  const double edge = k.pixel_centre - 0.5;  // of the first pixel
  const double left = (edge - k.cx) / k.fx;
  const double right = (k.width + edge - k.cx) / k.fx;
  const double top = (edge - k.cy) / k.fy;
  const double bottom = (k.height + edge - k.cy) / k.fy;
  return power_w / (solid_angle_sr(right, bottom) - solid_angle_sr(left, bottom) -
                    solid_angle_sr(right, top) + solid_angle_sr(left, top));
}

std::vector<float> projected_line(const FringePatterns& patterns, const ProjectorLight& light,
                                  std::size_t image) {
  std::vector<double> line;
  for (const std::uint16_t level : pattern_line(patterns, image)) {
    const double share = level / kMaxGrey;
    line.push_back(light.gamma == 1.0 ? share : portable_pow(share, light.gamma));
  }
  return blurred(line, light.blur_px);
}

}  // namespace glidar
