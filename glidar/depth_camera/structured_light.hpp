// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/depth_camera/fringes.hpp>
#include <glidar/depth_camera/imager.hpp>
#include <glidar/sensor/optics/pinhole.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glidar {

class FieldVisitor;

/// The keys projector and projector_from_camera. A reader sets the size of the patterns, which are
/// read afterwards. `text` documents the projector.
void visit_projector(FieldVisitor& visitor, const char* text, Pinhole& projector,
                     Pose& projector_from_camera, FringePatterns& patterns);

/// Throws Error when the projector is at the position of the camera, so that there are no depths.
/// `where` is the owner of the pose.
void validate_baseline(const std::string& where, const Pose& projector_from_camera);

/// The light of a projector of images.
struct ProjectorLight {
  double power_w = 0.5;           ///< optical, of an image of the greatest level
  double gamma = 1.0;             ///< light of a level, shares of the greatest: level^gamma
  double blur_px = 0.5;           ///< standard deviation of its Gaussian point spread, own pixels
  double speckle_contrast = 0.0;  ///< standard deviation over mean; independent in each image
};

/// Keys of `light` of structured-light cameras.
void describe(ProjectorLight& light, FieldVisitor& visitor);

/// The radiant intensity of an image of the greatest level, W/sr, the same in all directions of the
/// image: the power over the solid angle of the image without lens distortion. The part of the
/// plane z = 1 from the axis to (x, y) covers atan(x y / sqrt(1 + x^2 + y^2)) (Khadjavi,
/// Calculation of solid angle subtended by rectangular apertures, J. Opt. Soc. Am. 58, 1968).
double white_intensity_w_per_sr(const Pinhole& projector, double power_w);

/// Light of pattern i at the centres of the projector's pixels along the encoded axis, as a share
/// of that of the greatest level: 8-bit levels, the projector's gamma, then its point spread.
std::vector<float> projected_line(const FringePatterns& patterns, const ProjectorLight& light,
                                  std::size_t image);

/// Light at a coordinate, whole numbers are centres of pixels: linear between them, and beyond the
/// outer centres that of the outer pixel.
inline float light_at(std::span<const float> line, float coordinate_px) {
  const float place = std::clamp(coordinate_px, 0.0F, static_cast<float>(line.size() - 1));
  const auto left = static_cast<std::size_t>(place);
  const std::size_t right = std::min(left + 1, line.size() - 1);
  return line[left] + (place - static_cast<float>(left)) * (line[right] - line[left]);
}

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

/// A camera and a projector of fringes with a Gray code: depths come from one image of each
/// pattern. The sensor's optics are the camera.
struct StructuredLightCamera {
  static constexpr TypeInfo kType = {
      "structured_light",
      "images of fringes and a Gray code, decoded by glidar depth structured-light"};

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

/// Decoded images and their depths.
struct MeasuredFringes {
  DecodedFringes decoded;
  std::vector<float> depth_m;  ///< NaN unless the status is valid
};

/// decode_fringes() and triangulate(). A pixel whose coordinate leads to no depth becomes
/// inconsistent, without a coordinate. Throws Error as they do. `pool` may be null.
MeasuredFringes measure_fringes(std::span<const GreyImage> images, const StructuredLight& setup,
                                ThreadPool* pool = nullptr);

/// explain_fringes() of a pixel as measure_fringes() decodes it: a coordinate that leads to no
/// depth is a further test, which fails.
FringeTrace explain_fringes(std::span<const GreyImage> images, const StructuredLight& setup,
                            std::array<std::uint32_t, 2> column_row);

}  // namespace glidar
