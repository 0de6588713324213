// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth_camera/fringes.hpp>
#include <glidar/depth_camera/imager.hpp>
#include <glidar/depth_camera/stereo.hpp>
#include <glidar/depth_camera/time_of_flight.hpp>

#include <variant>
#include <vector>

namespace glidar {

/// How a pixel of an active stereo camera got its depth or the cause of its hole.
struct StereoPixelTrace {
  Exposure exposure;
  PixelLight light;      ///< of the pixel of the left image, mean electrons
  PixelReading reading;  ///< its random numbers and grey level
  /// Of the pixel in the right image that shows the same surface point by the ground truth; without
  /// light where there is none, or where the second image is a stored pattern.
  PixelLight right_light;
  double true_disparity_px = 0.0;  ///< NaN for a miss
  StereoTrace match;
};

/// How a pixel of a time-of-flight camera got its range or the cause of its hole.
struct TofPixelTrace {
  std::vector<TofLight> light = {};  ///< of each phase step, frequency by frequency
  double bounced_share = 0.0;        ///< of the modulated light, over diffuse bounces
  TofTrace decoded;
};

/// How a pixel of a structured-light camera got its depth or the cause of its hole.
struct StructuredLightPixelTrace {
  Exposure exposure;
  std::vector<double> electrons = {};  ///< of each image: the mean without noise
  double true_projector_px = 0.0;      ///< coordinate of the surface; NaN where it is not lit
  FringeTrace decoded = {};
};

/// How a pixel got its depth, by the type of the camera.
using DepthTrace = std::variant<StereoPixelTrace, TofPixelTrace, StructuredLightPixelTrace>;

}  // namespace glidar
