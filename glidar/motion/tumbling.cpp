// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/tumbling.hpp>

#include <glidar/core/error.hpp>
#include <glidar/motion/elliptic.hpp>
#include <glidar/motion/times.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace glidar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

[[noreturn]] void refuse(const std::string& field, std::string found, std::string allowed) {
  throw Error({"tumbling, " + field, std::move(found), std::move(allowed), ""});
}

void check(const TumblingStart& start) {
  const Vector3d& moments = start.moments_kg_m2;
  if (!moments.allFinite() || !(moments.minCoeff() > 0.0)) {
    refuse("moments of inertia", "one is not above 0", "three finite numbers above 0");
  }
  constexpr double kThinnest = 1e-9;
  if (moments.minCoeff() < kThinnest * moments.maxCoeff()) {
    refuse("moments of inertia", "one is more than 1e9 times another", "moments of like size");
  }
  constexpr double kRounding = 1e-6;  // of moments given in decimals: a thin plate is at the limit
  if (moments.maxCoeff() > (1.0 + kRounding) * (moments.sum() - moments.maxCoeff())) {
    refuse("moments of inertia", "one is larger than the two others together",
           "moments of a body: none above the sum of the others");
  }
  if (!start.rate_rad_s.allFinite()) refuse("rates", "not finite", "three finite numbers");
  if (!start.velocity_m_s.allFinite()) refuse("velocity", "not finite", "three finite numbers");
  if (!is_rigid(start.world_from_body) || !is_rigid(start.body_from_principal)) {
    refuse("pose", "not a rigid transform", "finite numbers and a rotation");
  }
}

/// Euler's equations without torque: the moment times the change of rate, about each axis.
Vector3d gyroscopic(const Vector3d& moments, const Vector3d& rate) {
  const auto part = [&](int j, int k) { return (moments[j] - moments[k]) * rate[j] * rate[k]; };
  return {part(1, 2), part(2, 0), part(0, 1)};
}

/// True when the rate stays as it is: the body turns about a principal axis. What is nearer to that
/// than the squares of doubles can tell counts too.
bool is_steady(const Vector3d& moments, const Vector3d& rate) {
  constexpr double kNothing = 1e-140;
  return gyroscopic(moments, rate).norm() <= kNothing * rate.squaredNorm();
}

/// L^2 - 2 E I_2 for ordered axes, without cancellation: its sign tells about which axis the body
/// turns.
double about_last(const Vector3d& moments, const Vector3d& rate) {
  return moments[0] * rate[0] * rate[0] * (moments[0] - moments[1]) +
         moments[2] * rate[2] * rate[2] * (moments[2] - moments[1]);
}

/// The rotation to axes of which the second has the middle moment and the third keeps the sign of
/// its rate for all time.
Matrix3d ordered_axes(const Vector3d& moments, const Vector3d& rate) {
  std::array<int, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return moments[a] < moments[b]; });
  Matrix3d axes = Matrix3d::Zero();
  for (int row = 0; row < 3; ++row) axes(row, order[static_cast<std::size_t>(row)]) = 1.0;
  if (about_last(axes * moments, axes * rate) < 0.0) axes.row(0).swap(axes.row(2));
  if (axes.determinant() < 0.0) axes.row(0) = -axes.row(0);
  return axes;
}

}  // namespace

/// Everything in ordered axes, see ordered_axes(). Equations: Landau & Lifshitz, section 37.
struct Tumbling::Solution {
  Matrix3d ordered_from_principal;
  Vector3d moments;
  Vector3d amplitude;  ///< of the rates: those of cn, sn, dn, with their signs
  EllipticModulus modulus;
  double phase_rate = 0.0;      ///< of the elliptic functions' argument, 1/s (37.9)
  double phase0 = 0.0;          ///< at t0
  double momentum = 0.0;        ///< L
  double characteristic = 0.0;  ///< of the third elliptic integral; never above 0
  Matrix3d world_from_node0;    ///< of the frame of node line and angular momentum at phase 0

  Solution(const Vector3d& principal_moments, const Vector3d& principal_rate,
           const Matrix3d& world_from_principal);

  [[nodiscard]] double phase(double seconds) const { return phase0 + phase_rate * seconds; }
  [[nodiscard]] Vector3d rate(double phase) const;
  [[nodiscard]] double precession(double seconds) const;
  [[nodiscard]] Matrix3d node_from_ordered(double phase) const;
};

Vector3d Tumbling::Solution::rate(double phase) const {
  const JacobiValues j = jacobi(modulus, phase);  // (37.10)
  return {amplitude[0] * j.cn, amplitude[1] * j.sn, amplitude[2] * j.dn};
}

/// The angle by which the node line has turned about the angular momentum since t0: the integral of
/// (37.16), L (I1 w1^2 + I2 w2^2) / (I1^2 w1^2 + I2^2 w2^2) = L / I3 + L (I3 - I1) / (I1 I3) /
/// (1 - n sn^2) with n = -I3 (I2 - I1) / (I1 (I3 - I2)).
double Tumbling::Solution::precession(double seconds) const {
  const double integral = elliptic_pi(modulus, characteristic, phase(seconds)) -
                          elliptic_pi(modulus, characteristic, phase0);
  return momentum / moments[2] * seconds +
         momentum * (moments[2] - moments[0]) / (moments[0] * moments[2] * phase_rate) * integral;
}

/// From the body to the axes: node line (angular momentum x third axis), the one across, angular
/// momentum.
Matrix3d Tumbling::Solution::node_from_ordered(double phase) const {
  const Vector3d along = moments.cwiseProduct(rate(phase)).normalized();
  const Vector3d node = Vector3d(along.y(), -along.x(), 0.0).stableNormalized();
  Matrix3d axes;
  axes << node.transpose(), along.cross(node).transpose(), along.transpose();
  return axes;
}

Tumbling::Solution::Solution(const Vector3d& principal_moments, const Vector3d& principal_rate,
                             const Matrix3d& world_from_principal)
    : ordered_from_principal(ordered_axes(principal_moments, principal_rate)) {
  moments = (ordered_from_principal * principal_moments).cwiseAbs();
  const Vector3d w = ordered_from_principal * principal_rate;
  const Vector3d& i = moments;
  const Vector3d e = i.cwiseProduct(w).cwiseProduct(w);
  const double below = e[0] * (i[2] - i[0]) + e[1] * (i[2] - i[1]);  // 2 E I3 - L^2
  const double above = e[1] * (i[1] - i[0]) + e[2] * (i[2] - i[0]);  // L^2 - 2 E I1
  const double scale = (i[2] - i[1]) * above;
  constexpr double kSeparatrix = 1e-30;  // a quarter period of 36
  const double complement = std::clamp((i[2] - i[0]) * about_last(i, w) / scale, kSeparatrix, 1.0);
  modulus = make_modulus(std::clamp((i[1] - i[0]) * below / scale, 0.0, 1.0), complement);
  // the signs make Euler's equations hold: that of w1 w2 w3 changes with the order of the moments
  const double sign3 = std::copysign(1.0, w[2]);
  const double sign2 = i[2] > i[1] ? sign3 : -sign3;
  amplitude = {std::sqrt(below / (i[0] * (i[2] - i[0]))),
               sign2 * std::sqrt(below / (i[1] * (i[2] - i[1]))),
               sign3 * std::sqrt(above / (i[2] * (i[2] - i[0])))};
  phase_rate = std::sqrt(scale / (i[0] * i[1] * i[2]));
  const double sn = w[1] / amplitude[1];
  const double cn = w[0] / amplitude[0];
  const double length = std::hypot(sn, cn);  // 1 but for rounding
  phase0 = elliptic_f(modulus, sn / length, cn / length);
  momentum = i.cwiseProduct(w).norm();
  characteristic = -i[2] * (i[1] - i[0]) / (i[0] * (i[2] - i[1]));
  world_from_node0 =
      world_from_principal * (node_from_ordered(phase0) * ordered_from_principal).transpose();
}

Tumbling::Tumbling(const TumblingStart& start) : start_(start) {
  check(start_);
  const Vector3d moments = start_.moments_kg_m2 / start_.moments_kg_m2.maxCoeff();
  if (is_steady(moments, start_.rate_rad_s)) return;
  const Pose world_from_principal = start_.world_from_body * start_.body_from_principal;
  solution_ =
      std::make_shared<const Solution>(moments, start_.rate_rad_s, world_from_principal.linear());
}

Vector3d Tumbling::rate_at(std::int64_t t_ns) const {
  if (!solution_) return start_.rate_rad_s;
  const double phase = solution_->phase(seconds_between(start_.t0_ns, t_ns));
  return solution_->ordered_from_principal.transpose() * solution_->rate(phase);
}

Pose Tumbling::pose_at(std::int64_t t_ns) const {
  const double seconds = seconds_between(start_.t0_ns, t_ns);
  Pose world_from_principal = start_.world_from_body * start_.body_from_principal;
  world_from_principal.translation() += start_.velocity_m_s * seconds;
  if (!solution_) {
    world_from_principal.linear() *=
        exponential(start_.rate_rad_s * seconds, Vector3d::Zero()).linear();
  } else {
    const Matrix3d turned =
        Eigen::AngleAxisd(solution_->precession(seconds), Vector3d::UnitZ()).toRotationMatrix();
    world_from_principal.linear() = solution_->world_from_node0 * turned *
                                    solution_->node_from_ordered(solution_->phase(seconds)) *
                                    solution_->ordered_from_principal;
  }
  return world_from_principal * start_.body_from_principal.inverse();
}

}  // namespace glidar
