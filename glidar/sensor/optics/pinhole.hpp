// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/field.hpp>
#include <glidar/sensor/optics/firing_schedule.hpp>

#include <cstdint>
#include <limits>
#include <variant>

namespace glidar {

class FieldVisitor;

struct NoDistortion {
  static constexpr TypeInfo kType = {"none", "no distortion"};
};

/// OpenCV's rational radial-tangential model (calib3d documentation, "Detailed Description"):
/// x'' = x' (1+k1 r2+k2 r4+k3 r6)/(1+k4 r2+k5 r4+k6 r6) + 2 p1 x'y' + p2 (r2 + 2 x'2), and
/// y'' = y' (...)/(...) + p1 (r2 + 2 y'2) + 2 p2 x'y'.
struct RadialTangential {
  static constexpr TypeInfo kType = {"radial_tangential", "rational model", "OpenCV, calib3d"};
  double k1 = 0.0;
  double k2 = 0.0;
  double p1 = 0.0;
  double p2 = 0.0;
  double k3 = 0.0;
  double k4 = 0.0;
  double k5 = 0.0;
  double k6 = 0.0;
  /// Maximum distance from the axis, on the plane z = 1, that the lens images ("metric radius" in
  /// calibrations of the Azure Kinect). Pixels farther out have no beam.
  double max_radius = std::numeric_limits<double>::infinity();
};

/// OpenCV's fisheye model (calib3d "Fisheye camera model", after Kannala and Brandt 2006):
/// theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8).
struct Fisheye {
  static constexpr TypeInfo kType = {"fisheye", "fisheye model", "OpenCV, calib3d"};
  double k1 = 0.0;
  double k2 = 0.0;
  double k3 = 0.0;
  double k4 = 0.0;
};

using Distortion = std::variant<NoDistortion, RadialTangential, Fisheye>;

/// A camera: one ray per pixel, in the optical frame (x right, y down, z forward).
struct Pinhole {
  static constexpr TypeInfo kType = {"pinhole", "a camera, with or without lens distortion"};
  PinholeIntrinsics intrinsics;
  Distortion distortion;
};

/// Keys of `optics` in sensor files.
void describe(Pinhole& pinhole, FieldVisitor& visitor);
void describe(Distortion& distortion, FieldVisitor& visitor);
void describe(NoDistortion& none, FieldVisitor& visitor);
void describe(RadialTangential& k, FieldVisitor& visitor);
void describe(Fisheye& k, FieldVisitor& visitor);

/// Maximum width and height of an image, in pixels.
inline constexpr std::uint32_t kMaxImageSide = 65536;
/// Maximum magnitude of focal lengths and principal points, in pixels.
inline constexpr double kFarthestPixel = 1e9;

/// The focal length in pixels at which `pixels` span the angle `fov_rad`.
double focal_length_px(std::uint32_t pixels, double fov_rad);

/// A camera with square pixels and a centred principal point: fy = height / (2 tan(fov_y / 2)).
/// Throws Error unless 0 < fov_y_rad < pi and both sizes are at least 1.
Pinhole pinhole_from_fov(std::uint32_t width, std::uint32_t height, double fov_y_rad);

/// One beam per pixel, all at the start of the interval. Pixels at which the distortion model is
/// not invertible have no beam. Throws Error if a number is out of range.
Beams make_beams(const Pinhole& pinhole, const FrameInterval& interval = {});

}  // namespace glidar
