// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/pinhole.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/math/portable.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

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

namespace {

/// Models of one or two spheres: a point is projected onto a unit sphere, which is shifted by xi
/// along the axis, then onto a second one, and from a point of its axis onto the image. With
/// q = (sqrt(beta) x, sqrt(beta) y, z), d1 = |q| and d2 = |(q_x, q_y, xi d1 + z)|, the image is
/// scale (x, y) / (alpha d2 + (1 - alpha) (xi d1 + z)). beta = 1: Usenko, Demmel and Cremers, "The
/// Double Sphere Camera Model", 3DV 2018; xi = 0: Khomutenko, Garcia and Martinet, "An Enhanced
/// Unified Camera Model", RA-L 2016; both: Mei and Rives, ICRA 2007, with xi = alpha / (1 - alpha).
struct Spheres {
  double xi;
  double alpha;
  double beta;
  double scale;
};

Eigen::Vector3d stretched(const Spheres& s, const Eigen::Vector3d& point) {
  const double root = std::sqrt(s.beta);
  return {root * point.x(), root * point.y(), point.z()};
}

/// Where a point is imaged; empty: nowhere.
std::optional<Eigen::Vector2d> sphere_place(const Spheres& s, const Eigen::Vector3d& point) {
  const Eigen::Vector3d q = stretched(s, point);
  const double w = s.xi * q.norm() + q.z();
  const double d2 = std::sqrt(q.x() * q.x() + q.y() * q.y() + w * w);
  const double below = s.alpha * d2 + (1.0 - s.alpha) * w;
  // beyond this angle the image folds over (alpha > 1/2) or the denominator is not positive
  const double side = s.alpha <= 0.5 ? s.alpha / (1.0 - s.alpha) : (1.0 - s.alpha) / s.alpha;
  if (!(w > -side * d2) || !(below > 0.0)) return {};
  return Eigen::Vector2d(point.head<2>() * (s.scale / below));
}

/// Derivative of sphere_place(), where there is an image.
Eigen::Matrix<double, 2, 3> sphere_derivative(const Spheres& s, const Eigen::Vector3d& point) {
  const Eigen::Vector3d q = stretched(s, point);
  const double d1 = q.norm();
  const double w = s.xi * d1 + q.z();
  const double d2 = std::sqrt(q.x() * q.x() + q.y() * q.y() + w * w);
  const double below = s.alpha * d2 + (1.0 - s.alpha) * w;
  const Eigen::Vector3d slope_w = s.xi / d1 * q + Eigen::Vector3d::UnitZ();  // by q
  const Eigen::Vector3d level(q.x(), q.y(), 0.0);
  const Eigen::Vector3d slope = s.alpha / d2 * (level + w * slope_w) + (1.0 - s.alpha) * slope_w;
  const Eigen::Vector3d by_point = stretched(s, slope);
  Eigen::Matrix<double, 2, 3> j = -point.head<2>() * by_point.transpose() / (below * below);
  j(0, 0) += 1.0 / below;
  j(1, 1) += 1.0 / below;
  return s.scale * j;
}

/// The unit ray through a place of the image; NaN if there is none.
Eigen::Vector3d sphere_ray(const Spheres& s, const Eigen::Vector2d& place) {
  const double root = std::sqrt(s.beta);
  const Eigen::Vector2d m = root / s.scale * place;
  const double r2 = m.squaredNorm();
  const double inner = 1.0 - (2.0 * s.alpha - 1.0) * r2;
  if (!(inner >= 0.0)) return Eigen::Vector3d::Constant(kNaN);
  const double mz = (1.0 - s.alpha * s.alpha * r2) / (s.alpha * std::sqrt(inner) + 1.0 - s.alpha);
  const double onto = mz * mz + (1.0 - s.xi * s.xi) * r2;
  if (!(onto >= 0.0)) return Eigen::Vector3d::Constant(kNaN);
  const double k = (mz * s.xi + std::sqrt(onto)) / (mz * mz + r2);
  const Eigen::Vector3d q(k * m.x(), k * m.y(), k * mz - s.xi);
  return Eigen::Vector3d(q.x() / root, q.y() / root, q.z()).normalized();
}

using Place = std::optional<Eigen::Vector2d>;

constexpr int kMaxNewtonSteps = 50;
constexpr double kConverged =
    1e-14;  // residual on the normalised plane: below any pixel's rounding
const Eigen::Vector3d kNoRay = Eigen::Vector3d::Constant(kNaN);

/// The angle of the vector (x, y) from +x, -pi to pi.
double signed_angle(double y, double x) {
  const double turns = atan2_turns(y, x);
  return kTwoPi * (turns > 0.5 ? turns - 1.0 : turns);
}

/// Projection onto the plane z = 1.
Eigen::Vector2d on_plane(const Eigen::Vector3d& point) {
  return point.head<2>() / point.z();
}

/// Its derivative.
ImageDerivative plane_derivative(const Eigen::Vector3d& point) {
  const double w = 1.0 / point.z();
  ImageDerivative j;
  j << w, 0.0, -point.x() * w * w, 0.0, w, -point.y() * w * w;
  return j;
}

// Distortions of the plane z = 1

/// OpenCV's computeTiltProjectionMatrix: R = R_y(tau_y) R_x(tau_x), then back onto the sensor.
Eigen::Matrix3d tilt_of(const RadialTangential& k) {
  const SineCosine x = sincos_turns(k.tau_x / kTwoPi);
  const SineCosine y = sincos_turns(k.tau_y / kTwoPi);
  Eigen::Matrix3d about_x;
  about_x << 1.0, 0.0, 0.0, 0.0, x.cosine, x.sine, 0.0, -x.sine, x.cosine;
  Eigen::Matrix3d about_y;
  about_y << y.cosine, 0.0, -y.sine, 0.0, 1.0, 0.0, y.sine, 0.0, y.cosine;
  const Eigen::Matrix3d rotation = about_y * about_x;
  Eigen::Matrix3d onto;
  onto << rotation(2, 2), 0.0, -rotation(0, 2), 0.0, rotation(2, 2), -rotation(1, 2), 0.0, 0.0, 1.0;
  return onto * rotation;
}

bool is_tilted(const RadialTangential& k) {
  return k.tau_x != 0.0 || k.tau_y != 0.0;
}

Eigen::Vector2d mapped(const Eigen::Matrix3d& homography, const Eigen::Vector2d& p) {
  return on_plane(homography * Eigen::Vector3d(p.x(), p.y(), 1.0));
}

/// Before the tilt.
Eigen::Vector2d distorted(const RadialTangential& k, const Eigen::Vector2d& p) {
  const double r2 = p.squaredNorm();
  const double radial =
      (1.0 + r2 * (k.k1 + r2 * (k.k2 + r2 * k.k3))) / (1.0 + r2 * (k.k4 + r2 * (k.k5 + r2 * k.k6)));
  const double xy = p.x() * p.y();
  return {p.x() * radial + 2.0 * k.p1 * xy + k.p2 * (r2 + 2.0 * p.x() * p.x()) +
              r2 * (k.s1 + r2 * k.s2),
          p.y() * radial + k.p1 * (r2 + 2.0 * p.y() * p.y()) + 2.0 * k.p2 * xy +
              r2 * (k.s3 + r2 * k.s4)};
}

/// Derivative of `distorted`, by the chain rule.
Eigen::Matrix2d distortion_jacobian(const RadialTangential& k, const Eigen::Vector2d& p) {
  const double r2 = p.squaredNorm();
  const double above = 1.0 + r2 * (k.k1 + r2 * (k.k2 + r2 * k.k3));
  const double below = 1.0 + r2 * (k.k4 + r2 * (k.k5 + r2 * k.k6));
  const double above_slope = k.k1 + r2 * (2.0 * k.k2 + 3.0 * r2 * k.k3);
  const double below_slope = k.k4 + r2 * (2.0 * k.k5 + 3.0 * r2 * k.k6);
  const double radial = above / below;
  const double slope =
      (above_slope * below - above * below_slope) / (below * below);  // d radial/d r2
  const double prism_x = 2.0 * (k.s1 + 2.0 * r2 * k.s2);              // d/d r2, times 2
  const double prism_y = 2.0 * (k.s3 + 2.0 * r2 * k.s4);
  const double x = p.x();
  const double y = p.y();
  Eigen::Matrix2d j;
  j(0, 0) = radial + 2.0 * x * x * slope + 2.0 * k.p1 * y + 6.0 * k.p2 * x + x * prism_x;
  j(0, 1) = 2.0 * x * y * slope + 2.0 * k.p1 * x + 2.0 * k.p2 * y + y * prism_x;
  j(1, 0) = 2.0 * x * y * slope + 2.0 * k.p1 * x + 2.0 * k.p2 * y + x * prism_y;
  j(1, 1) = radial + 2.0 * y * y * slope + 6.0 * k.p1 * y + 2.0 * k.p2 * x + y * prism_y;
  return j;
}

/// Newton's method from the distorted place. The solution must be on the branch of the image
/// centre, where the Jacobian is positive: beyond it the model folds over and is invalid. Nothing
/// is imaged beyond max_radius either.
Place undistorted_place(const RadialTangential& k, const Eigen::Vector2d& place) {
  const Eigen::Vector2d aim = is_tilted(k) ? mapped(tilt_of(k).inverse(), place) : place;
  Eigen::Vector2d p = aim;
  const double tolerance = kConverged * (1.0 + aim.norm());
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    const Eigen::Vector2d residual = distorted(k, p) - aim;
    const Eigen::Matrix2d jacobian = distortion_jacobian(k, p);
    if (!(jacobian.determinant() > 0.0)) break;
    if (residual.norm() <= tolerance) {
      if (p.norm() > k.max_radius) break;
      return p;
    }
    p -= jacobian.inverse() * residual;
  }
  return {};
}

Place distorted_place(const RadialTangential& k, const Eigen::Vector2d& p) {
  if (!(distortion_jacobian(k, p).determinant() > 0.0)) return {};
  const Eigen::Vector2d place = distorted(k, p);
  return is_tilted(k) ? mapped(tilt_of(k), place) : place;
}

Eigen::Matrix2d place_jacobian(const RadialTangential& k, const Eigen::Vector2d& p) {
  const Eigen::Matrix2d jacobian = distortion_jacobian(k, p);
  if (!is_tilted(k)) return jacobian;
  const Eigen::Matrix3d tilt = tilt_of(k);
  const Eigen::Vector2d flat = distorted(k, p);
  const Eigen::Vector3d at = tilt * Eigen::Vector3d(flat.x(), flat.y(), 1.0);
  return plane_derivative(at) * tilt.leftCols<2>() * jacobian;
}

/// The radial part of the model is followed up to 89 degrees from the axis, in steps of a 1/200 of
/// the radius; the polynomials of calibrations are smooth at this scale.
constexpr double kMaxTangent = 57.0;
constexpr double kRadiusGrowth = 1.005;
constexpr double kFirstRadius = 0.01;

/// The least radius at which the radial part folds over. The other terms shift it a little, which
/// the determinant of the jacobian decides.
double fold_radius(const RadialTangential& k) {
  const RadialTangential radial = {k.k1, k.k2, 0.0, 0.0, k.k3, k.k4, k.k5, k.k6};
  for (double radius = kFirstRadius; radius < kMaxTangent; radius *= kRadiusGrowth) {
    if (distortion_jacobian(radial, {radius, 0.0}).determinant() <= 0.0) return radius;
  }
  return kMaxTangent;
}

// Models of the angle theta from the axis: radius of the image and its derivative

struct Radius {
  double value;
  double slope;
};

Radius radius_at(const Fisheye& k, double theta) {
  const double t2 = theta * theta;
  return {theta * (1.0 + t2 * (k.k1 + t2 * (k.k2 + t2 * (k.k3 + t2 * k.k4)))),
          1.0 + t2 * (3.0 * k.k1 + t2 * (5.0 * k.k2 + t2 * (7.0 * k.k3 + t2 * 9.0 * k.k4)))};
}

Radius radius_at(const FieldOfView& k, double theta) {
  const SineCosine at = sincos_turns(theta / kTwoPi);
  const SineCosine half = sincos_turns(0.5 * k.w / kTwoPi);
  const double rise = 2.0 * at.sine * half.sine;  // 2 tan theta tan(w / 2) = rise / run
  const double run = at.cosine * half.cosine;
  return {signed_angle(rise, run) / k.w,
          2.0 * half.sine * half.cosine / (k.w * (rise * rise + run * run))};
}

template <class Model>
Place imaged_by_angle(const Model& model, double limit, const Eigen::Vector3d& point) {
  const double side = point.head<2>().norm();
  const double theta = signed_angle(side, point.z());
  if (!(theta <= limit) || point.isZero(0.0)) return {};
  if (side == 0.0) return Eigen::Vector2d(0.0, 0.0);
  return Eigen::Vector2d(point.head<2>() * (radius_at(model, theta).value / side));
}

template <class Model>
ImageDerivative derivative_by_angle(const Model& model, const Eigen::Vector3d& point) {
  const double side = point.head<2>().norm();
  const Radius radius = radius_at(model, signed_angle(side, point.z()));
  if (side == 0.0) return radius.slope * plane_derivative(point);
  const Eigen::Vector2d out = point.head<2>() / side;
  const double length2 = point.squaredNorm();
  const Eigen::Matrix2d along = out * out.transpose();
  ImageDerivative j;
  j.leftCols<2>() = radius.value / side * (Eigen::Matrix2d::Identity() - along) +
                    radius.slope * point.z() / length2 * along;
  j.col(2) = -radius.slope * side / length2 * out;
  return j;
}

Eigen::Vector3d ray_at_angle(const Eigen::Vector2d& place, double radius, double theta) {
  const SineCosine at = sincos_turns(theta / kTwoPi);
  const Eigen::Vector2d side = place / radius * at.sine;
  return Eigen::Vector3d(side.x(), side.y(), at.cosine).normalized();
}

Spheres spheres_of(const Omni& k) {
  return {0.0, k.xi / (1.0 + k.xi), 1.0, 1.0 / (1.0 + k.xi)};
}
Spheres spheres_of(const DoubleSphere& k) {
  return {k.xi, k.alpha, 1.0, 1.0};
}
Spheres spheres_of(const ExtendedUnified& k) {
  return {0.0, k.alpha, k.beta, 1.0};
}

// The models: limit, ray, image and derivative

template <class Model>
double limit_of(const Model& /*none*/) {
  return kInfinity;
}
double limit_of(const RadialTangential& k) {
  return std::min(k.max_radius, fold_radius(k));
}
double limit_of(const Fisheye& k) {
  constexpr double kStep = 0.005;
  for (double theta = kStep; theta < std::numbers::pi; theta += kStep)
    if (!(radius_at(k, theta).slope > 0.0)) return theta - kStep;
  return std::numbers::pi;
}
double limit_of(const FieldOfView& /*k*/) {
  return 0.5 * std::numbers::pi;
}
double limit_of(const Omni& k) {
  return limit_of(k.lens);
}

Eigen::Vector3d ray_of(const NoDistortion& /*none*/, const Eigen::Vector2d& place) {
  return direction_through(place.x(), place.y());
}
Eigen::Vector3d ray_of(const RadialTangential& k, const Eigen::Vector2d& place) {
  const Place plane = undistorted_place(k, place);
  return plane ? direction_through(plane->x(), plane->y()) : kNoRay;
}
/// Newton's method on theta_d(theta) = r; see Fisheye.
Eigen::Vector3d ray_of(const Fisheye& k, const Eigen::Vector2d& place) {
  const double radius = place.norm();
  if (radius == 0.0) return Eigen::Vector3d::UnitZ();
  double theta = std::min(radius, std::numbers::pi);
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    const Radius at = radius_at(k, theta);
    if (!(at.slope > 0.0) || !(theta >= 0.0) || theta > std::numbers::pi) break;
    if (std::abs(at.value - radius) <= kConverged * (1.0 + radius))
      return ray_at_angle(place, radius, theta);
    theta -= (at.value - radius) / at.slope;
  }
  return kNoRay;
}
Eigen::Vector3d ray_of(const FieldOfView& k, const Eigen::Vector2d& place) {
  const double radius = place.norm();
  if (radius == 0.0) return Eigen::Vector3d::UnitZ();
  if (!(radius * k.w < 0.5 * std::numbers::pi)) return kNoRay;
  const SineCosine at = sincos_turns(radius * k.w / kTwoPi);
  const SineCosine half = sincos_turns(0.5 * k.w / kTwoPi);
  const double theta = signed_angle(at.sine * half.cosine, 2.0 * at.cosine * half.sine);
  return ray_at_angle(place, radius, theta);
}
Eigen::Vector3d ray_of(const Omni& k, const Eigen::Vector2d& place) {
  const Place plane = undistorted_place(k.lens, place);
  return plane ? sphere_ray(spheres_of(k), *plane) : kNoRay;
}
Eigen::Vector3d ray_of(const DoubleSphere& k, const Eigen::Vector2d& place) {
  return sphere_ray(spheres_of(k), place);
}
Eigen::Vector3d ray_of(const ExtendedUnified& k, const Eigen::Vector2d& place) {
  return sphere_ray(spheres_of(k), place);
}
Eigen::Vector3d ray_of(const Equirectangular& /*k*/, const Eigen::Vector2d& place) {
  constexpr double kRounding = 1e-9;
  if (!(std::abs(place.x()) <= std::numbers::pi + kRounding) ||
      !(std::abs(place.y()) <= 0.5 * std::numbers::pi + kRounding))
    return kNoRay;
  const SineCosine longitude = sincos_turns(place.x() / kTwoPi);
  const SineCosine latitude = sincos_turns(place.y() / kTwoPi);
  return Eigen::Vector3d(latitude.cosine * longitude.sine, latitude.sine,
                         latitude.cosine * longitude.cosine)
      .normalized();
}

Place image_of(const NoDistortion& /*none*/, double /*limit*/, const Eigen::Vector3d& point) {
  if (!(point.z() > 0.0)) return {};
  return on_plane(point);
}
Place image_of(const RadialTangential& k, double limit, const Eigen::Vector3d& point) {
  if (!(point.z() > 0.0)) return {};
  const Eigen::Vector2d plane = on_plane(point);
  if (!(plane.squaredNorm() <= limit * limit)) return {};
  return distorted_place(k, plane);
}
Place image_of(const Fisheye& k, double limit, const Eigen::Vector3d& point) {
  return imaged_by_angle(k, limit, point);
}
Place image_of(const FieldOfView& k, double limit, const Eigen::Vector3d& point) {
  if (!(point.z() > 0.0)) return {};
  return imaged_by_angle(k, limit, point);
}
Place image_of(const Omni& k, double limit, const Eigen::Vector3d& point) {
  const Place plane = sphere_place(spheres_of(k), point);
  if (!plane || !(plane->squaredNorm() <= limit * limit)) return {};
  return distorted_place(k.lens, *plane);
}
Place image_of(const DoubleSphere& k, double /*limit*/, const Eigen::Vector3d& point) {
  return sphere_place(spheres_of(k), point);
}
Place image_of(const ExtendedUnified& k, double /*limit*/, const Eigen::Vector3d& point) {
  return sphere_place(spheres_of(k), point);
}
Place image_of(const Equirectangular& /*k*/, double /*limit*/, const Eigen::Vector3d& point) {
  if (point.isZero(0.0)) return {};
  const double level = std::sqrt(point.x() * point.x() + point.z() * point.z());
  return Eigen::Vector2d(signed_angle(point.x(), point.z()), signed_angle(point.y(), level));
}

ImageDerivative derivative_of(const NoDistortion& /*none*/, const Eigen::Vector3d& point) {
  return plane_derivative(point);
}
ImageDerivative derivative_of(const RadialTangential& k, const Eigen::Vector3d& point) {
  return place_jacobian(k, on_plane(point)) * plane_derivative(point);
}
ImageDerivative derivative_of(const Fisheye& k, const Eigen::Vector3d& point) {
  return derivative_by_angle(k, point);
}
ImageDerivative derivative_of(const FieldOfView& k, const Eigen::Vector3d& point) {
  return derivative_by_angle(k, point);
}
ImageDerivative derivative_of(const Omni& k, const Eigen::Vector3d& point) {
  const Spheres spheres = spheres_of(k);
  const Eigen::Vector2d plane =
      sphere_place(spheres, point).value_or(Eigen::Vector2d::Constant(kNaN));
  return place_jacobian(k.lens, plane) * sphere_derivative(spheres, point);
}
ImageDerivative derivative_of(const DoubleSphere& k, const Eigen::Vector3d& point) {
  return sphere_derivative(spheres_of(k), point);
}
ImageDerivative derivative_of(const ExtendedUnified& k, const Eigen::Vector3d& point) {
  return sphere_derivative(spheres_of(k), point);
}
ImageDerivative derivative_of(const Equirectangular& /*k*/, const Eigen::Vector3d& point) {
  const double level2 = point.x() * point.x() + point.z() * point.z();
  const double level = std::sqrt(level2);
  const double fall = -point.y() / (level * point.squaredNorm());
  ImageDerivative j;
  j << point.z() / level2, 0.0, -point.x() / level2, point.x() * fall, level / point.squaredNorm(),
      point.z() * fall;
  return j;
}

}  // namespace

double distortion_limit(const Distortion& model) {
  return std::visit([](const auto& k) { return limit_of(k); }, model);
}

Eigen::Vector3d undistorted_ray(const Distortion& model, const Eigen::Vector2d& place) {
  return std::visit([&](const auto& k) { return ray_of(k, place); }, model);
}

std::optional<Eigen::Vector2d> imaged(const Distortion& model, double limit,
                                      const Eigen::Vector3d& point) {
  return std::visit([&](const auto& k) { return image_of(k, limit, point); }, model);
}

ImageDerivative imaged_derivative(const Distortion& model, const Eigen::Vector3d& point) {
  return std::visit([&](const auto& k) { return derivative_of(k, point); }, model);
}

PinholeProjection::PinholeProjection(const Pinhole& pinhole)
    : pinhole_(pinhole), limit_(distortion_limit(pinhole.distortion)) {}

std::optional<Eigen::Vector2d> PinholeProjection::pixel_of(const Eigen::Vector3d& point) const {
  const auto place = imaged(pinhole_.distortion, limit_, point);
  if (!place) return {};
  const PinholeIntrinsics& k = pinhole_.intrinsics;
  return Eigen::Vector2d(k.fx * place->x() + pinhole_.skew_px * place->y() + k.cx - k.pixel_centre,
                         k.fy * place->y() + k.cy - k.pixel_centre);
}

Eigen::Matrix<double, 2, 3> PinholeProjection::pixel_derivative(
    const Eigen::Vector3d& point) const {
  const PinholeIntrinsics& k = pinhole_.intrinsics;
  Eigen::Matrix2d pixels;
  pixels << k.fx, pinhole_.skew_px, 0.0, k.fy;
  return pixels * imaged_derivative(pinhole_.distortion, point);
}

Eigen::Vector3d PinholeProjection::ray_through(const Eigen::Vector2d& pixel) const {
  const PinholeIntrinsics& k = pinhole_.intrinsics;
  const double y = (pixel.y() + k.pixel_centre - k.cy) / k.fy;
  const double x = (pixel.x() + k.pixel_centre - k.cx - pinhole_.skew_px * y) / k.fx;
  return undistorted_ray(pinhole_.distortion, {x, y});
}

Pinhole divide_pixels(const Pinhole& camera, std::uint32_t sub_rays) {
  const PinholeIntrinsics& pixel = camera.intrinsics;
  const double n = sub_rays;
  return {{.width = pixel.width * sub_rays,
           .height = pixel.height * sub_rays,
           .fx = pixel.fx * n,
           .fy = pixel.fy * n,
           .cx = (pixel.cx - pixel.pixel_centre + 0.5) * n,
           .cy = (pixel.cy - pixel.pixel_centre + 0.5) * n,
           .pixel_centre = 0.5},
          camera.distortion,
          camera.skew_px * n};
}

void check_sub_rays(const PinholeIntrinsics& image, std::uint32_t sub_rays) {
  constexpr double kMaxRays = 0x1p25;  // a few GiB with what they hit
  const double rays = static_cast<double>(image.width) * image.height * sub_rays * sub_rays;
  if (rays <= kMaxRays) return;
  throw Error({.where = "depth_camera",
               .found = "sub_rays is " + std::to_string(sub_rays) + ", so that " +
                        std::to_string(image.width) + "x" + std::to_string(image.height) +
                        " pixels have too many rays",
               .allowed = "at most " + number_text(kMaxRays) + " rays",
               .remedy = "use fewer sub_rays or pixels"});
}

}  // namespace glidar
