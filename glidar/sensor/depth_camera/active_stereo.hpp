// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/field.hpp>
#include <glidar/sensor/depth_camera/ambient_light.hpp>
#include <glidar/sensor/depth_camera/dot_projector.hpp>
#include <glidar/sensor/depth_camera/imager.hpp>
#include <glidar/stereo/stereo_options.hpp>

#include <Eigen/Core>
#include <cstdint>

namespace glidar {

class FieldVisitor;

/// A stereo camera with a projector: depths come from infrared images by stereo matching. The
/// sensor's optics are the left camera; the right one has the same, displaced along +x.
struct ActiveStereo {
  static constexpr TypeInfo kType = {"active_stereo",
                                     "infrared images of a dot pattern, matched by glidar stereo"};

  /// What the left image is matched with.
  enum class Reference : std::uint8_t {
    right_imager,
    /// The stored pattern as a camera at the position of the projector would see it (Kinect v1);
    /// the baseline is that of the projector.
    pattern
  };

  Reference reference = Reference::right_imager;
  double baseline_m = 0.05;     ///< from the left to the right camera
  double depth_unit_m = 0.001;  ///< depths are multiples of this; 0: not rounded
  std::uint32_t sub_rays = 3;   ///< each pixel is the mean of sub_rays x sub_rays rays
  DotProjector projector;
  AmbientLight illumination;
  Imager imager;
  StereoOptions matcher;
};

/// Keys of `depth_camera` with `type: active_stereo`.
void describe(ActiveStereo& camera, FieldVisitor& visitor);

/// Position of the right camera, or of the projector for Reference::pattern, in the frame of the
/// left camera.
Eigen::Vector3d second_origin_m(const ActiveStereo& camera);

/// Throws Error naming the first value that does not fit the others or the matcher.
void validate(const ActiveStereo& camera);

/// Throws Error when the image is narrower than the matcher's search, or too large for it or for
/// the sub-rays.
void check_image(const ActiveStereo& camera, const PinholeIntrinsics& image);

}  // namespace glidar
