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
void fill_directions(const Pinhole& pinhole, std::vector<Eigen::Vector3d>& directions) {
  const PinholeIntrinsics& k = pinhole.intrinsics;
  std::size_t i = 0;
  for (std::uint32_t v = 0; v < k.height; ++v) {
    const double y = plane_y(k, v);
    const double shift = pinhole.skew_px * y / k.fx;
    for (std::uint32_t u = 0; u < k.width; ++u)
      directions[i++] = undistorted_ray(pinhole.distortion, {plane_x(k, u) - shift, y});
  }
}

constexpr const char* kCoefficient = "coefficient";
constexpr const char* kCalibrationFile = "calibration_file";  // read by glidar/io
constexpr const char* kInstead = "this or `calibration_file`";

void visit_side(FieldVisitor& visitor, const FieldInfo& field, std::uint32_t& side) {
  const bool is_schema = visitor.mode() == FieldVisitor::Mode::schema;
  visitor.at_most_one({{kCalibrationFile, field.key},
                       "one of the two",
                       is_schema ? "the size of the image is missing" : nullptr});
  visitor.whole_number(field, {1, kMaxImageSide}, side);
}

constexpr const char* kFocalLengths = "one of fov_deg, fov_x_deg, or fx with fy";

/// fy, cx and cy belong to fx: with a field of view the pixels are square and the principal point
/// is in the middle.
void exclude_beside_fov(FieldVisitor& visitor, const std::string& fov) {
  const std::string remedy = "remove it, or give fx and fy instead of " + fov;
  for (const char* key : {"fy", "cx", "cy"})
    visitor.at_most_one({.keys = {fov.c_str(), key},
                         .allowed = "fy, cx and cy only together with fx",
                         .conflict_remedy = remedy.c_str()});
}

/// The focal length of an image with this many pixels along the side that a field of view spans.
void visit_field_of_view(FieldVisitor& visitor, const FieldInfo& field, std::uint32_t side,
                         PinholeIntrinsics& k) {
  double fov_rad = 0.0;
  exclude_beside_fov(visitor, field.key);
  visitor.number(field, {0.0, 180.0, true, "degrees above 0 and below 180"}, fov_rad);
  if (!visitor.is_reading() || !visitor.has(field.key)) return;
  k.fx = k.fy = focal_length_px(side, fov_rad);
  if (k.fx > 0.0 && k.fx < kFarthestPixel) return;
  visitor.reject(field.key, "{}, a focal length of " + number_text(k.fx) + " pixels",
                 "a field of view that gives pixels above 0 and below 1e9");
}

/// Without any, equirectangular images have the whole sphere.
void visit_focal_length(FieldVisitor& visitor, Pinhole& pinhole) {
  constexpr NumberRule kFocalLength = {0.0, kFarthestPixel, true, "pixels above 0 and below 1e9"};
  PinholeIntrinsics& k = pinhole.intrinsics;
  constexpr KeyCase kPanorama = {"distortion", "model", Equirectangular::kType.name};
  visitor.at_most_one({.keys = {kCalibrationFile, "fov_deg", "fov_x_deg", "fx"},
                       .allowed = kFocalLengths,
                       .missing = "the focal length is missing",
                       .remedy = "add 'fov_deg: ...'",
                       .none_needed = kPanorama});
  visitor.excludes({kPanorama,
                    {"fov_deg", "fov_x_deg"},
                    "given for an equirectangular image",
                    "fx and fy, pixels per radian",
                    "leave it out: the image has the whole sphere"});
  if (visitor.is_reading() && std::holds_alternative<Equirectangular>(pinhole.distortion)) {
    k.fx = k.width / kTwoPi;
    k.fy = k.height / std::numbers::pi;
  }
  if (!visitor.is_writing()) {
    visit_field_of_view(visitor, {"fov_deg", "vertical field of view", kUnitDegree, false, ""},
                        k.height, k);
    visit_field_of_view(visitor, {"fov_x_deg", "horizontal field of view", kUnitDegree, false, ""},
                        k.width, k);
  }
  visitor.needs({"fx", "fy", kFocalLengths, "add 'fy: ...'"});
  visitor.needs({"fy", "fx", kFocalLengths, "add 'fx: ...'"});
  visitor.number({"fx", "focal length, together with `fy`", kUnitPixel, false, ""}, kFocalLength,
                 k.fx);
  visitor.number({"fy", "focal length, together with `fx`", kUnitPixel, false, ""}, kFocalLength,
                 k.fy);
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
  require_number(std::abs(pinhole.skew_px) <= kFarthestPixel, "pinhole, skew", pinhole.skew_px,
                 "-1e9 to 1e9 pixels");
  fill_directions(pinhole, beams.directions);
  if (is_perspective(pinhole)) beams.pinhole = k;
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
                             {"k6", k.k6},
                             {"s1", k.s1},
                             {"s2", k.s2},
                             {"s3", k.s3},
                             {"s4", k.s4}}) {
    visitor.number({key, kCoefficient}, kFinite, value);
  }
  constexpr NumberRule kTilt = {-1.5, 1.5, false, "radians from -1.5 to 1.5"};
  visitor.number({"tau_x", "tilt of the image sensor, radians"}, kTilt, k.tau_x);
  visitor.number({"tau_y", "tilt of the image sensor, radians"}, kTilt, k.tau_y);
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

void describe(FieldOfView& k, FieldVisitor& visitor) {
  visitor.number({"w", "field of view of the ideal lens, radians", kNoUnit, kRequired},
                 {0.0, std::numbers::pi, true, "radians above 0, below pi"}, k.w);
}

void describe(Omni& k, FieldVisitor& visitor) {
  visitor.number(
      {"xi", "distance of the centre of projection from that of the sphere", kNoUnit, kRequired},
      {0.0, 1e3, false, "a number from 0 to 1000"}, k.xi);
  for (auto& [key, value] : {std::pair<const char*, double&>{"k1", k.lens.k1},
                             {"k2", k.lens.k2},
                             {"p1", k.lens.p1},
                             {"p2", k.lens.p2}}) {
    visitor.number({key, kCoefficient}, kFinite, value);
  }
}

void describe(DoubleSphere& k, FieldVisitor& visitor) {
  visitor.number({"xi", "distance between the centres of the spheres", kNoUnit, kRequired},
                 {-1.0, 1.0, true, "a number above -1, below 1"}, k.xi);
  visitor.number({"alpha", "place of the centre of projection", kNoUnit, kRequired}, kZeroToOne,
                 k.alpha);
}

void describe(ExtendedUnified& k, FieldVisitor& visitor) {
  visitor.number({"alpha", "place of the centre of projection", kNoUnit, kRequired}, kZeroToOne,
                 k.alpha);
  visitor.number({"beta", "shape of the ellipsoid", kNoUnit, kRequired},
                 {0.0, 1e3, true, "a number above 0, below 1000"}, k.beta);
}

void describe(Equirectangular& /*k*/, FieldVisitor& /*visitor*/) {}

void describe(Distortion& distortion, FieldVisitor& visitor) {
  visit_variant(visitor, {"model", "the distortion model", kNoUnit, kRequired}, distortion);
}

void describe(Pinhole& pinhole, FieldVisitor& visitor) {
  constexpr NumberRule kPixelCentre = {0.0, 1.0 - std::numeric_limits<double>::epsilon(), false,
                                       "a number from 0 to below 1; 0.5 and 0 are usual"};
  constexpr NumberRule kPrincipalPoint = {-kFarthestPixel, kFarthestPixel, false,
                                          "pixels from -1e9 to 1e9"};
  PinholeIntrinsics& k = pinhole.intrinsics;
  const bool is_required = visitor.is_reading() && k.width == 0;  // not after a calibration
  visit_side(visitor, {"width", "columns of the image", kUnitPixel, is_required, kInstead},
             k.width);
  visit_side(visitor, {"height", "rows of the image", kUnitPixel, is_required, kInstead}, k.height);
  const FieldInfo distortion = {"distortion", "lens distortion, or projection of wide lenses",
                                kNoUnit, false, "none"};
  if (visitor.is_reading()) visit_object(visitor, distortion, pinhole.distortion);
  visit_focal_length(visitor, pinhole);
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
  visitor.number({"skew", "shift of a column per focal length of rows: K[0][1]", kUnitPixel},
                 kPrincipalPoint, pinhole.skew_px);
  if (!visitor.is_reading()) visit_object(visitor, distortion, pinhole.distortion);
}

}  // namespace glidar
