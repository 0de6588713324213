// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>
#include <glidar/sensor/depth_camera/ambient_light.hpp>
#include <glidar/sensor/depth_camera/imager.hpp>
#include <glidar/sensor/depth_camera/projector_light.hpp>
#include <glidar/sensor/depth_camera/structured_light.hpp>

#include <cstdint>

namespace glidar {

class FieldVisitor;

/// A camera and a projector of fringes with a Gray code: depths come from one image of each
/// pattern. The sensor's optics are the camera.
struct StructuredLightCamera {
  static constexpr TypeInfo kType = {
      "structured_light", "images of fringes and a Gray code, decoded by glidar structured-light"};

  Pinhole projector;  ///< its width and height are those of the patterns
  Pose projector_from_camera = Pose::Identity();
  ProjectorLight light;
  FringePatterns patterns;
  FringeDecoding decoding;
  AmbientLight illumination;
  Imager imager;
  std::uint32_t sub_rays = 3;     ///< each pixel is the mean of sub_rays x sub_rays rays
  double image_interval_s = 0.0;  ///< from the start of an image to the next
};

/// Keys of `depth_camera` with `type: structured_light`.
void describe(StructuredLightCamera& camera, FieldVisitor& visitor);

/// What decodes the images of this camera, with the sensor's optics.
StructuredLight setup_of(const StructuredLightCamera& camera, const Pinhole& optics);

/// Throws Error naming the first value that does not fit the others.
void validate(const StructuredLightCamera& camera);

/// Throws Error when all images together have too many pixels.
void check_image(const StructuredLightCamera& camera, const PinholeIntrinsics& image);

}  // namespace glidar
