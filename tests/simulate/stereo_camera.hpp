// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/constants.hpp>
#include <glidar/simulate/simulator.hpp>

#include <simulate/panels.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace glidar::testing {

inline constexpr double kStereoFocal_px = 430.14;
inline constexpr double kStereoBaseline_m = 0.05015;

/// A camera with the numbers of the D435 preset and this image, of which the axis is the middle.
inline Sensor stereo_sensor(std::uint32_t width = 240, std::uint32_t height = 120) {
  Sensor sensor;
  Pinhole pinhole;
  pinhole.intrinsics = {.width = width,
                        .height = height,
                        .fx = kStereoFocal_px,
                        .fy = kStereoFocal_px,
                        .cx = 0.5 * width,
                        .cy = 0.5 * height};
  sensor.optics = pinhole;
  sensor.wavelength_m = 850e-9;
  ActiveStereo camera;
  camera.baseline_m = kStereoBaseline_m;
  camera.projector.origin_m = {0.029, 0.0, 0.0};
  camera.projector.speckle_contrast = 0.5;
  camera.matcher.box_px = 9;
  camera.matcher.uniqueness_percent = 40;
  camera.matcher.disparities = 96;
  sensor.depth_camera = camera;
  sensor.depth_model = DepthModel::physical;
  return sensor;
}

inline ActiveStereo& stereo_camera(Sensor& sensor) {
  return std::get<ActiveStereo>(*sensor.depth_camera);
}

/// Even light over the field of the projector, without speckle, and a fixed exposure.
inline void use_even_light(Sensor& sensor) {
  ActiveStereo& camera = stereo_camera(sensor);
  constexpr std::uint32_t kSide = 512;
  camera.projector.pattern = {.width = kSide,
                              .height = kSide,
                              .level = std::vector<std::uint16_t>(std::size_t{kSide} * kSide, 9)};
  camera.projector.fov_x_rad = 60.0 * kDegree;
  camera.projector.fov_y_rad = 60.0 * kDegree;
  camera.projector.speckle_contrast = 0.0;
  camera.illumination.ambient_w_per_m2 = 0.0;
  camera.imager.exposure_s = 0.01;
}

/// A frame of a static scene from its origin.
inline Frame shoot(const Scene& scene, const Sensor& sensor, const RendererOptions& options = {},
                   std::uint64_t seed = 1) {
  return Simulator(scene, sensor, options)
      .simulate(Pose::Identity(), HitColumnMask{.depth = true}, seed);
}

inline const RawImage& image_of(const Frame& frame, const char* name) {
  return *std::find_if(frame.raw_images.begin(), frame.raw_images.end(),
                       [&](const RawImage& image) { return image.name == name; });
}

/// Share of the pixels with a status.
inline double share_of(const Frame& frame, Status status) {
  return static_cast<double>(std::count(frame.status.begin(), frame.status.end(), status)) /
         static_cast<double>(frame.status.size());
}

}  // namespace glidar::testing
