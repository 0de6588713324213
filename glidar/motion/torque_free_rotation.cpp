// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/torque_free_rotation.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/pose_keys.hpp>
#include <glidar/math/double_double.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/motion/rate_keys.hpp>
#include <glidar/motion/times.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

namespace glidar {
namespace {

/// Clenshaw's recurrence: the sum of c_k T_k(t).
template <std::size_t N>
double chebyshev_sum(const std::array<double, N>& c, double t) {
  double next = 0.0;
  double after = 0.0;
  for (std::size_t k = N - 1; k > 0; --k) {
    const double now = 2.0 * t * next - after + c[k];
    after = next;
    next = now;
  }
  return t * next - after + c[0];
}

/// Coefficients of a function's Chebyshev series, the first twice its own, from its values at the
/// nodes cos(pi (j + 1/2) / N); two more that are 0.
template <std::size_t N>
std::array<double, N + 2> chebyshev_series(const std::array<double, N>& values) {
  std::array<double, N + 2> series{};
  for (std::size_t k = 0; k < N; ++k) {
    for (std::size_t j = 0; j < N; ++j) {
      const double turns = static_cast<double>(k * (2 * j + 1)) / (4.0 * N);
      series[k] += 2.0 / N * values[j] * sincos_turns(turns).cosine;
    }
  }
  return series;
}

}  // namespace

IntegralTable::IntegralTable(double end, FunctionRef<double(double)> function) {
  const double count = std::max(1.0, std::ceil(end));
  const double length = end / count;
  per_segment_ = count / end;
  for (double start = 0.0; start < count; start += 1.0) {
    std::array<double, kNodes> values{};
    for (std::size_t j = 0; j < kNodes; ++j) {
      const double place = sincos_turns((static_cast<double>(j) + 0.5) / (2.0 * kNodes)).cosine;
      values[j] = function(length * (start + 0.5 * (1.0 + place)));
    }
    add_segment(length, chebyshev_series(values));
  }
}

void IntegralTable::add_segment(double length, const std::array<double, kNodes + 2>& series) {
  Segment segment{};
  double at_start = 0.0;
  double to_end = 0.0;
  for (std::size_t k = 1; k <= kNodes; ++k) {
    segment[k] = 0.25 * length * (series[k - 1] - series[k + 1]) / static_cast<double>(k);
    at_start += k % 2 == 0 ? segment[k] : -segment[k];
    to_end += segment[k];
  }
  segment[0] = total_ - at_start;
  total_ += to_end - at_start;
  segments_.push_back(segment);
}

double IntegralTable::at(double x) const {
  const double place = x * per_segment_;
  const double last = static_cast<double>(segments_.size() - 1);
  const double segment = std::clamp(std::floor(place), 0.0, last);
  return chebyshev_sum(segments_[static_cast<std::size_t>(segment)], 2.0 * (place - segment) - 1.0);
}

namespace {

/// The arithmetic-geometric mean of 1 and a number in [0, 1]; 0 for 0.
double mean_with_one(double b) {
  constexpr double kRelative = 1e-9;  // each step squares the difference
  double a = 1.0;
  if (!(b > 0.0)) return 0.0;
  while (a - b > kRelative * a) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 0.5 * (a + b);
}

/// Theta functions at one argument, divided by common factors.
struct Thetas {
  double one = 0.0;
  double two = 0.0;
  double three = 1.0;
  double four = 1.0;
};

/// Number of terms of each series: for a nome of at most exp(-pi) and an argument of at most a
/// quarter of the period, the omitted terms are below 1e-19.
constexpr int kTerms = 4;

/// At z, where 2 pi z is the angle: DLMF 20.2(i), the first two divided by 2 q^(1/4).
Thetas circular_thetas(double q, double turns) {
  Thetas sums;
  double power = 1.0;   // q^(n (n + 1))
  double square = q;    // q^((n + 1)^2)
  double single = 1.0;  // q^n
  for (int n = 0; n < kTerms; ++n) {
    const double sign = n % 2 == 0 ? 1.0 : -1.0;
    const SineCosine odd = sincos_turns((2 * n + 1) * turns);
    const double even = 2.0 * sincos_turns(2 * (n + 1) * turns).cosine;
    sums.one += sign * power * odd.sine;
    sums.two += power * odd.cosine;
    sums.three += square * even;
    sums.four -= sign * square * even;
    single *= q;
    power *= single * single;
    square *= single * single * q;
  }
  return sums;
}

/// At i v: the first two divided by q^(1/4) e^|v|, the first by i too. With p = e^(-2 |v|) and
/// w = q / p the terms are w^n q^(n^2) (1 -+ p^(2n + 1)) and w^n q^(n^2 - n) (1 + p^(2n)).
Thetas hyperbolic_thetas(double q, double v) {
  const double p = portable_exp(-2.0 * std::abs(v));
  const double w = q / p;
  Thetas sums;
  double power = 1.0;   // w^n q^(n^2)
  double square = w;    // w^(n + 1) q^(n^2 + n)
  double single = 1.0;  // q^n
  double odd = p;       // p^(2n + 1)
  for (int n = 0; n < kTerms; ++n) {
    const double sign = n % 2 == 0 ? 1.0 : -1.0;
    const double even = square * (1.0 + odd * p);
    sums.one += sign * power * (1.0 - odd);
    sums.two += power * (1.0 + odd);
    sums.three += even;
    sums.four -= sign * even;
    power *= w * single * single * q;
    single *= q;
    square *= w * single * single;
    odd *= p * p;
  }
  sums.one = std::copysign(sums.one, v);
  return sums;
}

/// Within half a quarter period of 0.
JacobiValues jacobi_near_zero(const EllipticModulus& modulus, double u) {
  const double v = modulus.argument_scale * u;
  const JacobiValues& scale = modulus.scale;
  if (!modulus.is_hyperbolic) {  // DLMF 22.2.4 to 22.2.6
    const Thetas at = circular_thetas(modulus.nome, v * (0.5 * std::numbers::inv_pi));
    return {scale.sn * at.one / at.four, scale.cn * at.two / at.four,
            scale.dn * at.three / at.four};
  }
  // sn = -i sc, cn = nc, dn = dc at i u of the complement: DLMF 22.6.1
  const Thetas at = hyperbolic_thetas(modulus.nome, v);
  const double decay = portable_exp(-std::abs(v)) / at.two;
  return {scale.sn * at.one / at.two, scale.cn * decay * at.four, scale.dn * decay * at.three};
}

}  // namespace

EllipticModulus make_modulus(double m, double complement) {
  EllipticModulus modulus{.m = m, .complement = std::max(complement, kMinComplement)};
  const double mean = mean_with_one(std::sqrt(modulus.complement));
  const double mean_of_complement = mean_with_one(std::sqrt(m));
  constexpr double kPi = std::numbers::pi;
  modulus.quarter_period = 0.5 * kPi / mean;
  modulus.is_hyperbolic = m > 0.5;
  // pi K' / K; the ratio of the means is its inverse
  const double ratio =
      modulus.is_hyperbolic ? mean_of_complement / mean : mean / mean_of_complement;
  modulus.nome = portable_exp(-kPi * ratio);
  modulus.argument_scale = modulus.is_hyperbolic ? mean_of_complement : mean;
  const Thetas zero = circular_thetas(modulus.nome, 0.0);
  if (modulus.is_hyperbolic) {
    modulus.scale = {zero.three / zero.four, 2.0 * zero.two / zero.four,
                     2.0 * zero.two / zero.three};
  } else {
    modulus.scale = {zero.three / zero.two, zero.four / zero.two, zero.four / zero.three};
  }
  return modulus;
}

JacobiValues jacobi(const EllipticModulus& modulus, double u) {
  const double quarter = std::floor(u / modulus.quarter_period + 0.5);
  JacobiValues j = jacobi_near_zero(modulus, u - quarter * modulus.quarter_period);
  const double place = quarter - 4.0 * std::floor(0.25 * quarter);
  if (place == 1.0 || place == 3.0) {
    const double root = std::sqrt(modulus.complement);
    j = {j.cn / j.dn, -root * j.sn / j.dn, root / j.dn};
  }
  if (place >= 2.0) {
    j.sn = -j.sn;
    j.cn = -j.cn;
  }
  return j;
}

double carlson_rf(double x, double y, double z) {
  constexpr double kReach = 338.4;  // (3 epsilon)^(-1/6)
  const double mean0 = (x + y + z) / 3.0;
  const double spread = std::max({std::abs(mean0 - x), std::abs(mean0 - y), std::abs(mean0 - z)});
  const double reach = kReach * spread;
  double mean = mean0;
  double quarter = 1.0;
  const double x0 = mean0 - x;
  const double y0 = mean0 - y;
  while (quarter * reach >= mean) {
    const double lambda =
        std::sqrt(x) * std::sqrt(y) + std::sqrt(y) * std::sqrt(z) + std::sqrt(z) * std::sqrt(x);
    x = 0.25 * (x + lambda);
    y = 0.25 * (y + lambda);
    z = 0.25 * (z + lambda);
    mean = 0.25 * (mean + lambda);
    quarter *= 0.25;
  }
  const double dx = x0 * quarter / mean;
  const double dy = y0 * quarter / mean;
  const double dz = -dx - dy;
  const double e2 = dx * dy - dz * dz;
  const double e3 = dx * dy * dz;
  return (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0) / std::sqrt(mean);
}

double elliptic_f(const EllipticModulus& modulus, double sine, double cosine) {
  const double cosine2 = cosine * cosine;
  const double first = sine * carlson_rf(cosine2, modulus.complement + modulus.m * cosine2, 1.0);
  // by reflection beyond a quarter turn
  return cosine >= 0.0 ? first : std::copysign(2.0 * modulus.quarter_period, sine) - first;
}

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

[[noreturn]] void refuse(const std::string& field, std::string found, std::string allowed) {
  throw Error({"tumbling, " + field, std::move(found), std::move(allowed)});
}

/// Euler's equations without torque: moment of inertia times angular acceleration, for each axis.
Vector3d gyroscopic(const Vector3d& moments, const Vector3d& rate) {
  const auto part = [&](int j, int k) { return (moments[j] - moments[k]) * rate[j] * rate[k]; };
  return {part(1, 2), part(2, 0), part(0, 1)};
}

/// True if the rate is constant, i.e. the body rotates about a principal axis. Off-axis rates whose
/// squares underflow relative to the total are ignored.
bool is_steady(const Vector3d& moments, const Vector3d& rate) {
  constexpr double kNone = 1e-140;
  return gyroscopic(moments, rate).norm() <= kNone * moments.maxCoeff() * rate.squaredNorm();
}

/// L^2 - 2 E I_2 for ordered axes. Its sign decides about which axis the body rotates. Near the
/// separatrix, where it cancels, its value decides when the body flips; therefore it is computed in
/// double-double precision.
double about_last(const Vector3d& moments, const Vector3d& rate) {
  const auto term = [&](int axis) {
    return exact_product(moments[axis], rate[axis]) * rate[axis] *
           exact_sum(moments[axis], -moments[1]);
  };
  return (term(0) + term(2)).high;
}

/// The rotation to axes of which the second has the intermediate moment and the third always has a
/// positive rate.
Matrix3d ordered_axes(const Vector3d& moments, const Vector3d& rate) {
  std::array<int, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return moments[a] < moments[b]; });
  Matrix3d axes = Matrix3d::Zero();
  for (int row = 0; row < 3; ++row) axes(row, order[static_cast<std::size_t>(row)]) = 1.0;
  if (about_last(axes * moments, axes * rate) < 0.0) axes.row(0).swap(axes.row(2));
  if (axes.row(2).dot(rate) < 0.0) axes.row(2) = -axes.row(2);
  if (axes.determinant() < 0.0) axes.row(0) = -axes.row(0);
  return axes;
}

/// Rodrigues' formula.
Matrix3d rotation_about(const Vector3d& axis, double turns) {
  const SineCosine angle = sincos_turns(turns);
  const Vector3d sine = angle.sine * axis;
  Matrix3d cross;
  cross << 0.0, -sine.z(), sine.y(), sine.z(), 0.0, -sine.x(), -sine.y(), sine.x(), 0.0;
  return angle.cosine * Matrix3d::Identity() + cross +
         (1.0 - angle.cosine) * axis * axis.transpose();
}

/// The shortest rotation that maps a unit vector with z >= 0 to the z axis.
Matrix3d shortest_to_z(const Vector3d& v) {
  const double scale = 1.0 / (1.0 + v.z());
  const double xy = -scale * v.x() * v.y();
  Matrix3d axes;
  axes << 1.0 - scale * v.x() * v.x(), xy, -v.x(), xy, 1.0 - scale * v.y() * v.y(), -v.y(), v.x(),
      v.y(), v.z();
  return axes;
}

/// A power of two of the magnitude of the largest number: division by it is exact.
double size_of(const Vector3d& numbers) {
  return std::ldexp(1.0, std::ilogb(numbers.cwiseAbs().maxCoeff()));
}

}  // namespace

void validate(const InitialRotation& start) {
  const Vector3d& moments = start.moments_kg_m2;
  if (!moments.allFinite() || !(moments.minCoeff() > 0.0)) {
    refuse("moments of inertia", "one is not above 0", "three finite numbers above 0");
  }
  constexpr double kThinnest = 1e-9;
  if (moments.minCoeff() < kThinnest * moments.maxCoeff()) {
    refuse("moments of inertia", "one is more than 1e9 times another", "ratios up to 1e9");
  }
  constexpr double kRounding = 1e-6;  // for moments in decimals: a thin plate is at the limit
  if (moments.maxCoeff() > (1.0 + kRounding) * (moments.sum() - moments.maxCoeff())) {
    refuse("moments of inertia", "one exceeds the sum of the other two",
           "moments of a rigid body: none above the sum of the other two");
  }
  if (!start.rate_rad_s.allFinite()) refuse("rates", "not finite", "three finite numbers");
  if (!start.velocity_m_s.allFinite()) refuse("velocity", "not finite", "three finite numbers");
  if (!is_rigid(start.world_from_body) || !is_rigid(start.body_from_principal)) {
    refuse("pose", "not a rigid transform", "finite numbers and a rotation");
  }
}

void describe(InitialRotation& start, FieldVisitor& visitor) {
  visitor.vector({"moments_kg_m2",
                  "principal moments of inertia; only ratios matter, none may exceed the sum of "
                  "the others",
                  {"kg m²"},
                  kRequired},
                 kAboveZero, visitor.is_writing(), start.moments_kg_m2);
  visit_rate(visitor, true, start.rate_rad_s);
  visit_velocity(visitor, "`[x, y, z]`, of the centre of mass in the world", start.velocity_m_s);
  visit_pose(visitor,
             {"principal",
              "pose of the centre of mass and of the principal axes in the object, after `scale`",
              kNoUnit, false, "identity"},
             visitor.is_writing(), start.body_from_principal);
  if (!visitor.is_reading()) return;
  try {
    validate(start);
  } catch (const Error& error) {
    visitor.reject("moments_kg_m2", error.parts().found, error.parts().allowed);
  }
}

/// The solution in ordered axes, see ordered_axes(), with rates in units of `unit`. The rates are
/// those of Landau and Lifshitz, section 37. The attitude is the shortest rotation that maps the
/// angular momentum L in the body to z, followed by a rotation about z. Unlike Euler angles it is
/// regular wherever L is within 90 degrees of the third axis, as it always is here. The rate of the
/// rotation about z is (w . l + w3) / (1 + l3) with l = L / |L|: all terms are positive.
struct TorqueFreeRotation::Solution {
  Matrix3d ordered_from_principal;
  Vector3d moments;
  double unit = 1.0;   ///< 1/s
  Vector3d amplitude;  ///< amplitudes of cn, sn, dn in the rates, with their signs
  EllipticModulus modulus;
  double phase_rate = 0.0;  ///< of the elliptic functions' argument (37.9)
  double phase0 = 0.0;      ///< at t0
  double turn_rate = 0.0;   ///< about L, for dn = 1
  double correction = 0.0;  ///< amplitude of the correction, see turn()
  IntegralTable integral;   ///< over a quarter period, see turn()
  double integral0 = 0.0;   ///< at t0
  Matrix3d world_from_momentum;

  /// `rate` is in units of rate_unit.
  Solution(const Vector3d& principal_moments, const Vector3d& principal_rate, double rate_unit,
           const Matrix3d& world_from_principal);

  [[nodiscard]] double phase(double seconds) const {
    return phase0 + phase_rate * (unit * seconds);
  }
  [[nodiscard]] Vector3d rate(double phase) const;
  [[nodiscard]] double integral_to(double phase) const;
  [[nodiscard]] double turn(double seconds) const;
  [[nodiscard]] Matrix3d momentum_from_ordered(double phase) const;
  void compute_turn_constants(double below);
};

Vector3d TorqueFreeRotation::Solution::rate(double phase) const {
  const JacobiValues j = jacobi(modulus, phase);  // (37.10)
  return {amplitude[0] * j.cn, amplitude[1] * j.sn, amplitude[2] * j.dn};
}

/// The integral of sn^2 / ((1 + dn) (1 + l3)) from 0 to any phase, with l3 = I3 w3 / L.
double TorqueFreeRotation::Solution::integral_to(double phase) const {
  const double half = 2.0 * modulus.quarter_period;
  const double halves = std::floor(phase / half + 0.5);
  const double rest = phase - halves * half;
  return 2.0 * halves * integral.total() + std::copysign(integral.at(std::abs(rest)), rest);
}

/// The angle about L since t0. With w3 = a3 dn, (2 E / L + w3) / (1 + l3) is its value at dn = 1
/// and (2 E I3 - L^2) / L^2 a3 (1 - dn) / ((1 + l3) (1 + I3 a3 / L)), where 1 - dn = m sn^2 / (1 +
/// dn): nothing cancels, even if the phase hardly changes.
double TorqueFreeRotation::Solution::turn(double seconds) const {
  return turn_rate * (unit * seconds) + correction * (integral_to(phase(seconds)) - integral0);
}

/// `below` is 2 E I3 - L^2.
void TorqueFreeRotation::Solution::compute_turn_constants(double below) {
  const Vector3d w = rate(phase0);
  const double momentum = moments.cwiseProduct(w).norm();
  const double third_axis_share = moments[2] * amplitude[2] / momentum;
  const double energy2 = w.dot(moments.cwiseProduct(w));
  turn_rate = (energy2 / momentum + amplitude[2]) / (1.0 + third_axis_share);
  correction = below / (momentum * momentum) * amplitude[2] * modulus.m /
               ((1.0 + third_axis_share) * phase_rate);
  const auto rest = [&](double u) {
    const JacobiValues j = jacobi(modulus, u);
    return j.sn * j.sn / ((1.0 + j.dn) * (1.0 + third_axis_share * j.dn));
  };
  integral = IntegralTable(modulus.quarter_period, FunctionRef<double(double)>(rest));
  integral0 = integral_to(phase0);
}

Matrix3d TorqueFreeRotation::Solution::momentum_from_ordered(double phase) const {
  return shortest_to_z(moments.cwiseProduct(rate(phase)).normalized());
}

TorqueFreeRotation::Solution::Solution(const Vector3d& principal_moments,
                                       const Vector3d& principal_rate, double rate_unit,
                                       const Matrix3d& world_from_principal)
    : ordered_from_principal(ordered_axes(principal_moments, principal_rate)), unit(rate_unit) {
  moments = (ordered_from_principal * principal_moments).cwiseAbs();
  const Vector3d w = ordered_from_principal * principal_rate;
  const Vector3d& i = moments;
  const Vector3d e = i.cwiseProduct(w).cwiseProduct(w);
  const double below = e[0] * (i[2] - i[0]) + e[1] * (i[2] - i[1]);  // 2 E I3 - L^2
  const double above = e[1] * (i[1] - i[0]) + e[2] * (i[2] - i[0]);  // L^2 - 2 E I1
  const double scale = (i[2] - i[1]) * above;
  modulus = make_modulus(std::clamp((i[1] - i[0]) * below / scale, 0.0, 1.0),
                         std::clamp((i[2] - i[0]) * about_last(i, w) / scale, 0.0, 1.0));
  // The signs satisfy Euler's equations: that of w1 w2 w3 changes with the order of the moments.
  const double sign2 = i[2] > i[1] ? 1.0 : -1.0;
  amplitude = {std::sqrt(below / (i[0] * (i[2] - i[0]))),
               sign2 * std::sqrt(below / (i[1] * (i[2] - i[1]))),
               std::sqrt(above / (i[2] * (i[2] - i[0])))};
  phase_rate = std::sqrt(scale / (i[0] * i[1] * i[2]));
  const double sn = w[1] / amplitude[1];
  const double cn = w[0] / amplitude[0];
  const double length = std::sqrt(sn * sn + cn * cn);  // 1 up to rounding
  phase0 = elliptic_f(modulus, sn / length, cn / length);
  compute_turn_constants(below);
  world_from_momentum =
      world_from_principal * (momentum_from_ordered(phase0) * ordered_from_principal).transpose();
}

TorqueFreeRotation::TorqueFreeRotation(const InitialRotation& start) : start_(start) {
  validate(start_);
  if (start_.rate_rad_s.isZero(0.0)) return;
  // Powers of two, so that nothing is rounded and no square overflows or underflows.
  const double unit = size_of(start_.rate_rad_s);
  const Vector3d rate = start_.rate_rad_s / unit;
  const Vector3d moments = start_.moments_kg_m2 / size_of(start_.moments_kg_m2);
  if (is_steady(moments, rate)) return;
  const Pose world_from_principal = start_.world_from_body * start_.body_from_principal;
  solution_ = std::make_shared<const Solution>(moments, rate, unit, world_from_principal.linear());
}

Vector3d TorqueFreeRotation::rate_at(std::int64_t t_ns) const {
  if (!solution_) return start_.rate_rad_s;
  const double phase = solution_->phase(seconds_between(start_.t0_ns, t_ns));
  return solution_->unit * (solution_->ordered_from_principal.transpose() * solution_->rate(phase));
}

Vector3d TorqueFreeRotation::angular_acceleration_at(std::int64_t t_ns) const {
  if (!solution_) return Vector3d::Zero();
  const Vector3d rate = rate_at(t_ns) / solution_->unit;
  const Vector3d moments = start_.moments_kg_m2 / size_of(start_.moments_kg_m2);
  return solution_->unit * solution_->unit * gyroscopic(moments, rate).cwiseQuotient(moments);
}

Pose TorqueFreeRotation::pose_at(std::int64_t t_ns) const {
  const double seconds = seconds_between(start_.t0_ns, t_ns);
  Pose world_from_principal = start_.world_from_body * start_.body_from_principal;
  world_from_principal.translation() += start_.velocity_m_s * seconds;
  constexpr double kTurns = 0.5 * std::numbers::inv_pi;
  if (solution_) {
    world_from_principal.linear() =
        solution_->world_from_momentum *
        rotation_about(Vector3d::UnitZ(), kTurns * solution_->turn(seconds)) *
        solution_->momentum_from_ordered(solution_->phase(seconds)) *
        solution_->ordered_from_principal;
  } else if (const double rate = start_.rate_rad_s.stableNorm(); rate > 0.0) {
    world_from_principal.linear() *=
        rotation_about(start_.rate_rad_s / rate, kTurns * (rate * seconds));
  }
  return world_from_principal * start_.body_from_principal.inverse();
}

}  // namespace glidar
