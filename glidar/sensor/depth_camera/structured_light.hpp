// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>
#include <glidar/sensor/optics/pinhole.hpp>
#include <glidar/structured_light/fringe_decoder.hpp>

#include <vector>

namespace glidar {

/// A camera and a projector, with their patterns: everything that turns images into depth.
struct StructuredLight {
  Pinhole camera;
  Pinhole projector;  ///< its width and height are those of the patterns
  Pose projector_from_camera = Pose::Identity();
  FringePatterns patterns;
  FringeDecoding decoding;
};

/// Keys of a setup file of structured light.
void describe(StructuredLight& setup, FieldVisitor& visitor);

/// Depth along the boresight of the camera, metres, for each of its pixels: where the ray of the
/// pixel meets the plane (with distortion, the surface) of points that the projector sees at the
/// decoded coordinate. NaN where there is no coordinate, or the intersection is not in front of
/// both. A phase error s gives the depth one of z^2 / (f b) T / (2 pi) s for parallel axes, with
/// the focal length f and the period T on the camera. Throws Error when the images have not the
/// camera's size.
std::vector<float> triangulate(const DecodedFringes& decoded, const StructuredLight& setup);

/// The same, with the rays of the camera's pixels: make_beams(setup.camera). `pool` may be null.
std::vector<float> triangulate(const DecodedFringes& decoded, const StructuredLight& setup,
                               const Beams& camera_rays, ThreadPool* pool);

}  // namespace glidar
