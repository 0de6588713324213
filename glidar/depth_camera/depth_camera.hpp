// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/field.hpp>
#include <glidar/depth_camera/dot_projector.hpp>
#include <glidar/depth_camera/imager.hpp>
#include <glidar/depth_camera/stereo.hpp>
#include <glidar/depth_camera/structured_light.hpp>
#include <glidar/depth_camera/time_of_flight.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <variant>

namespace glidar {

class FieldVisitor;

/// A stereo camera with a projector: depths come from infrared images by stereo matching. The
/// sensor's optics are the left camera; the right one has the same, displaced along +x.
struct ActiveStereo {
  static constexpr TypeInfo kType = {
      "active_stereo", "infrared images of a dot pattern, matched by glidar depth stereo"};

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

/// How a depth camera's measurement is simulated.
enum class DepthModel : std::uint8_t {
  law,      ///< the true depth with the sensor's noise steps
  physical  ///< from the raw images of the sensor's depth_camera, without noise steps
};

/// What DepthModel::physical simulates.
using DepthCamera = std::variant<ActiveStereo, TofCamera, StructuredLightCamera>;

/// Keys of `depth_camera` of sensor files: `type` and those of the type.
void describe(DepthCamera& camera, FieldVisitor& visitor);

/// Key `depth_model` of sensor files.
void visit_depth_model(DepthModel& model, FieldVisitor& visitor);

}  // namespace glidar
