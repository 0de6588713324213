// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/lens_distortion.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace glidar {
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

}  // namespace glidar
