// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/field.hpp>
#include <glidar/sensor/optics/firing_schedule.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <variant>

namespace glidar {

class FieldVisitor;

struct NoDistortion {
  static constexpr TypeInfo kType = {"none", "no distortion"};
};

/// OpenCV's rational radial-tangential model (calib3d documentation, "Detailed Description"):
/// x'' = x' (1+k1 r2+k2 r4+k3 r6)/(1+k4 r2+k5 r4+k6 r6) + 2 p1 x'y' + p2 (r2 + 2 x'2) + s1 r2 +
/// s2 r4, and y'' = y' (...)/(...) + p1 (r2 + 2 y'2) + 2 p2 x'y' + s3 r2 + s4 r4, then the tilt of
/// the image sensor by tau_x and tau_y.
struct RadialTangential {
  static constexpr TypeInfo kType = {
      "radial_tangential", "rational model, thin prism and tilted sensor", "OpenCV, calib3d"};
  double k1 = 0.0;
  double k2 = 0.0;
  double p1 = 0.0;
  double p2 = 0.0;
  double k3 = 0.0;
  double k4 = 0.0;
  double k5 = 0.0;
  double k6 = 0.0;
  double s1 = 0.0;
  double s2 = 0.0;
  double s3 = 0.0;
  double s4 = 0.0;
  double tau_x = 0.0;  ///< radians
  double tau_y = 0.0;
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

/// The FOV model of Devernay and Faugeras (2001), as in Kalibr: r_d = atan(2 r tan(w / 2)) / w.
struct FieldOfView {
  static constexpr TypeInfo kType = {"fov", "field-of-view model", "Devernay and Faugeras 2001"};
  double w = 1.0;  ///< radians, above 0 and below pi
};

/// The unified model of Mei and Rives (2007), as OpenCV's omnidir and Kalibr have it: the point
/// (x, y, z) / d is projected from (0, 0, -xi), then distorted by k1, k2, p1 and p2 as by
/// RadialTangential.
struct Omni {
  static constexpr TypeInfo kType = {"omni", "unified model of mirrors and wide lenses",
                                     "Mei and Rives 2007; OpenCV, omnidir"};
  double xi = 0.0;  ///< from 0
  RadialTangential lens;
};

/// The double sphere model of Usenko, Demmel and Cremers (2018); `ds` in Kalibr.
struct DoubleSphere {
  static constexpr TypeInfo kType = {"double_sphere", "wide lens, `ds` in Kalibr",
                                     "Usenko et al. 2018"};
  double xi = 0.0;     ///< above -1, below 1
  double alpha = 0.5;  ///< 0 to 1
};

/// The extended unified model of Khomutenko, Garcia and Martinet (2016).
struct ExtendedUnified {
  static constexpr TypeInfo kType = {"eucm", "wide lens, extended unified model",
                                     "Khomutenko et al. 2016"};
  double alpha = 0.5;  ///< 0 to 1
  double beta = 1.0;   ///< above 0
};

/// A panorama: columns are longitudes (from z towards x), rows latitudes (from the horizon down).
struct Equirectangular {
  static constexpr TypeInfo kType = {"equirectangular", "panorama of equal angles"};
};

using Distortion = std::variant<NoDistortion, RadialTangential, Fisheye, FieldOfView, Omni,
                                DoubleSphere, ExtendedUnified, Equirectangular>;

/// A camera: one ray per pixel, in the optical frame (x right, y down, z forward).
struct Pinhole {
  static constexpr TypeInfo kType = {"pinhole", "a camera, with or without lens distortion"};
  PinholeIntrinsics intrinsics;
  Distortion distortion;
  double skew_px = 0.0;  ///< column += skew y: axes of the image that are not perpendicular
};

/// Whether rays are those of a perspective projection with perpendicular axes.
inline bool is_perspective(const Pinhole& pinhole) {
  return std::holds_alternative<NoDistortion>(pinhole.distortion) && pinhole.skew_px == 0.0;
}

/// Keys of `optics` in sensor files.
void describe(Pinhole& pinhole, FieldVisitor& visitor);
void describe(Distortion& distortion, FieldVisitor& visitor);
void describe(NoDistortion& none, FieldVisitor& visitor);
void describe(RadialTangential& k, FieldVisitor& visitor);
void describe(Fisheye& k, FieldVisitor& visitor);
void describe(FieldOfView& k, FieldVisitor& visitor);
void describe(Omni& k, FieldVisitor& visitor);
void describe(DoubleSphere& k, FieldVisitor& visitor);
void describe(ExtendedUnified& k, FieldVisitor& visitor);
void describe(Equirectangular& k, FieldVisitor& visitor);

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

/// Derivative of a place of the image by the point that is imaged there.
using ImageDerivative = Eigen::Matrix<double, 2, 3>;

/// How far from the axis a model is followed: a radius of the plane z = 1 (radial_tangential, fov),
/// an angle (fisheye), or a radius of the undistorted image (omni). Beyond it, the model has folded
/// over.
double distortion_limit(const Distortion& model);

/// The unit ray through a place of the image; NaN if there is none. Places count in focal lengths
/// from the principal point; of equirectangular images they are longitude and latitude.
Eigen::Vector3d undistorted_ray(const Distortion& model, const Eigen::Vector2d& place);

/// The inverse: where a point of the optical frame is imaged. Empty if it is not seen, also where
/// the model has folded over. `limit` is distortion_limit(model).
std::optional<Eigen::Vector2d> imaged(const Distortion& model, double limit,
                                      const Eigen::Vector3d& point);

/// Derivative of imaged(), where there is an image.
ImageDerivative imaged_derivative(const Distortion& model, const Eigen::Vector3d& point);

/// Finds the pixels of points, the inverse of make_beams(pinhole).
class PinholeProjection {
 public:
  explicit PinholeProjection(const Pinhole& pinhole);

  /// Column and row of the image of a point in the optical frame, where whole numbers are centres
  /// of pixels, also outside the image. Empty when the camera does not see it: a point behind it,
  /// unless the model looks back, or where the distortion model has folded over.
  [[nodiscard]] std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector3d& point) const;
  /// Derivative of pixel_of(), pixels per metre; NaN or infinite where there is no image.
  [[nodiscard]] Eigen::Matrix<double, 2, 3> pixel_derivative(const Eigen::Vector3d& point) const;
  /// The unit ray through a place of the image; NaN if there is none.
  [[nodiscard]] Eigen::Vector3d ray_through(const Eigen::Vector2d& pixel) const;

 private:
  Pinhole pinhole_;
  double limit_;  ///< distortion_limit()
};

/// A camera with `sub_rays` x `sub_rays` pixels in place of each: the centre of each block is the
/// centre of a pixel. The distortion is the same.
Pinhole divide_pixels(const Pinhole& camera, std::uint32_t sub_rays);

/// Throws Error when an image has too many rays for the memory.
void check_sub_rays(const PinholeIntrinsics& image, std::uint32_t sub_rays);

/// The index of ray i of sub_rays^2 of a pixel, of a camera with this number of columns.
inline std::size_t ray_of_pixel(std::size_t columns, std::size_t sub_rays, std::size_t pixel,
                                std::size_t i) {
  const std::size_t row = pixel / columns * sub_rays + i / sub_rays;
  return row * columns * sub_rays + pixel % columns * sub_rays + i % sub_rays;
}

}  // namespace glidar
