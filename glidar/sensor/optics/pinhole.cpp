// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/pinhole.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/portable.hpp>
#include <glidar/sensor/optics/lens_distortion.hpp>

#include <cmath>
#include <numbers>

namespace glidar {
namespace {

void validate(const PinholeIntrinsics& k) {
  require_number(k.width >= 1 && k.width <= kMaxImageSide, "pinhole, width", k.width,
                 "1 to 65536 pixels");
  require_number(k.height >= 1 && k.height <= kMaxImageSide, "pinhole, height", k.height,
                 "1 to 65536 pixels");
  require_number(k.fx > 0.0 && k.fx <= kFarthestPixel, "pinhole, fx", k.fx,
                 "above 0, up to 1e9 pixels");
  require_number(k.fy > 0.0 && k.fy <= kFarthestPixel, "pinhole, fy", k.fy,
                 "above 0, up to 1e9 pixels");
  require_number(std::abs(k.cx) <= kFarthestPixel, "pinhole, cx", k.cx, "-1e9 to 1e9 pixels");
  require_number(std::abs(k.cy) <= kFarthestPixel, "pinhole, cy", k.cy, "-1e9 to 1e9 pixels");
  require_number(k.pixel_centre >= 0.0 && k.pixel_centre < 1.0, "pinhole, pixel_centre",
                 k.pixel_centre, "0 to 1");
}

/// The unit direction of every pixel, row-major.
template <class Model>
void fill_directions(const PinholeIntrinsics& k, const Model& distortion,
                     std::vector<Eigen::Vector3d>& directions) {
  std::size_t i = 0;
  for (std::uint32_t v = 0; v < k.height; ++v) {
    for (std::uint32_t u = 0; u < k.width; ++u) {
      const Eigen::Vector2d plane(plane_x(k, u), plane_y(k, v));
      directions[i++] = undistorted_ray(distortion, plane);
    }
  }
}

constexpr const char* kCoefficient = "coefficient";
constexpr const char* kFocalLengths = "one of fov_deg, fov_x_deg, or fx with fy";

/// fy, cx and cy belong to fx: with a field of view the pixels are square and the principal point
/// is in the middle.
void reject_beside_fov(const FieldVisitor& visitor, const std::string& fov) {
  for (const char* key : {"fy", "cx", "cy"}) {
    if (!visitor.has(key)) continue;
    visitor.reject(key, "given beside '" + fov + "'", "fy, cx and cy only together with fx",
                   "remove it, or give fx and fy instead of " + fov);
  }
}

/// The focal length of an image with this many pixels along the side that a field of view spans.
void visit_field_of_view(FieldVisitor& visitor, const FieldInfo& field, std::uint32_t side,
                         PinholeIntrinsics& k) {
  double fov_rad = 0.0;
  visitor.number(field, {0.0, 180.0, true, "degrees above 0 and below 180"}, fov_rad);
  if (!visitor.is_reading() || !visitor.has(field.key)) return;
  reject_beside_fov(visitor, field.key);
  k.fx = k.fy = focal_length_px(side, fov_rad);
  if (k.fx > 0.0 && k.fx < kFarthestPixel) return;
  visitor.reject(field.key, "{}, a focal length of " + number_text(k.fx) + " pixels",
                 "a field of view that gives pixels above 0 and below 1e9");
}

void visit_focal_length(FieldVisitor& visitor, PinholeIntrinsics& k) {
  constexpr NumberRule kFocalLength = {0.0, kFarthestPixel, true, "pixels above 0 and below 1e9"};
  visitor.at_most_one({{"fov_deg", "fov_x_deg", "fx"},
                       kFocalLengths,
                       "the focal length is missing",
                       "add 'fov_deg: ...'"});
  if (!visitor.is_writing()) {
    visit_field_of_view(visitor, {"fov_deg", "vertical field of view", kUnitDegree, false, ""},
                        k.height, k);
    visit_field_of_view(visitor, {"fov_x_deg", "horizontal field of view", kUnitDegree, false, ""},
                        k.width, k);
  }
  const bool is_required = visitor.is_reading() && visitor.has("fx");
  visitor.number({"fx", "focal length, together with `fy`", kUnitPixel, is_required, ""},
                 kFocalLength, k.fx);
  visitor.number({"fy", "focal length, together with `fx`", kUnitPixel, is_required, ""},
                 kFocalLength, k.fy);
}

}  // namespace

double focal_length_px(std::uint32_t pixels, double fov_rad) {
  return static_cast<double>(pixels) / (2.0 * portable_tan(fov_rad / 2.0));
}

Pinhole pinhole_from_fov(std::uint32_t width, std::uint32_t height, double fov_y_rad) {
  require_number(fov_y_rad > 0.0 && fov_y_rad < std::numbers::pi, "pinhole, fov_y_rad", fov_y_rad,
                 "above 0 and below pi");
  const double focal = focal_length_px(height, fov_y_rad);
  Pinhole pinhole{.intrinsics = {.width = width,
                                 .height = height,
                                 .fx = focal,
                                 .fy = focal,
                                 .cx = 0.5 * width,
                                 .cy = 0.5 * height,
                                 .pixel_centre = 0.5},
                  .distortion = NoDistortion{}};
  validate(pinhole.intrinsics);
  return pinhole;
}

Beams make_beams(const Pinhole& pinhole, const FrameInterval& /*interval*/) {
  const PinholeIntrinsics& k = pinhole.intrinsics;
  validate(k);
  Beams beams;
  beams.rows = k.height;
  beams.cols = k.width;
  beams.frame_id = "camera_optical_frame";
  beams.directions.resize(std::size_t{k.height} * k.width);
  std::visit([&](const auto& distortion) { fill_directions(k, distortion, beams.directions); },
             pinhole.distortion);
  if (std::holds_alternative<NoDistortion>(pinhole.distortion)) beams.pinhole = k;
  return beams;
}

void describe(NoDistortion& /*none*/, FieldVisitor& /*visitor*/) {}

void describe(RadialTangential& k, FieldVisitor& visitor) {
  for (auto& [key, value] : {std::pair<const char*, double&>{"k1", k.k1},
                             {"k2", k.k2},
                             {"p1", k.p1},
                             {"p2", k.p2},
                             {"k3", k.k3},
                             {"k4", k.k4},
                             {"k5", k.k5},
                             {"k6", k.k6}}) {
    visitor.number({key, kCoefficient}, kFinite, value);
  }
  if (visitor.is_report() && std::isinf(k.max_radius)) return;
  visitor.number({"max_radius",
                  "largest distance from the axis that the lens images, on the plane z = 1; pixels "
                  "outside it have no beam",
                  kNoUnit, false, "no limit"},
                 kAboveZero, k.max_radius);
}

void describe(Fisheye& k, FieldVisitor& visitor) {
  for (auto& [key, value] :
       {std::pair<const char*, double&>{"k1", k.k1}, {"k2", k.k2}, {"k3", k.k3}, {"k4", k.k4}}) {
    visitor.number({key, kCoefficient}, kFinite, value);
  }
}

void describe(Distortion& distortion, FieldVisitor& visitor) {
  visit_variant(visitor, {"model", "the distortion model", kNoUnit, kRequired}, distortion);
}

void describe(Pinhole& pinhole, FieldVisitor& visitor) {
  constexpr WholeRule kSide = {1, kMaxImageSide};
  constexpr NumberRule kPixelCentre = {0.0, 1.0 - std::numeric_limits<double>::epsilon(), false,
                                       "a number from 0 to below 1; 0.5 and 0 are usual"};
  constexpr NumberRule kPrincipalPoint = {-kFarthestPixel, kFarthestPixel, false,
                                          "pixels from -1e9 to 1e9"};
  PinholeIntrinsics& k = pinhole.intrinsics;
  visitor.whole_number({"width", "columns of the image", kUnitPixel, kRequired}, kSide, k.width);
  visitor.whole_number({"height", "rows of the image", kUnitPixel, kRequired}, kSide, k.height);
  visit_focal_length(visitor, k);
  // The middle of the image: half its width from the left edge of pixel 0, whose centre has the
  // coordinate pixel_centre.
  const FieldInfo centre = {
      "pixel_centre",
      "coordinate of the centre of the first pixel; 0 for calibrations of OpenCV, ROS and Kalibr",
      kUnitPixel};
  if (visitor.is_reading()) {
    visitor.number(centre, kPixelCentre, k.pixel_centre);
    k.cx = 0.5 * k.width - 0.5 + k.pixel_centre;
    k.cy = 0.5 * k.height - 0.5 + k.pixel_centre;
  }
  visitor.number(
      {"cx", "principal point; only with `fx` and `fy`", kUnitPixel, false, "image centre"},
      kPrincipalPoint, k.cx);
  visitor.number(
      {"cy", "principal point; only with `fx` and `fy`", kUnitPixel, false, "image centre"},
      kPrincipalPoint, k.cy);
  visitor.number(centre, kPixelCentre, k.pixel_centre);
  visit_object(visitor, {"distortion", "lens distortion", kNoUnit, false, "none"},
               pinhole.distortion);
}

}  // namespace glidar
