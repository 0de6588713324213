// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/depth_camera/imager.hpp>
#include <glidar/stereo/stereo_trace.hpp>

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

}  // namespace glidar
