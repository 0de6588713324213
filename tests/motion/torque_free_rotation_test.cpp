// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/torque_free_rotation.hpp>

#include <glidar/core/error.hpp>

#include <gtest/gtest.h>
#include <support/source_folder.hpp>

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace glidar {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

struct Case {
  const char* name;
  Vector3d moments;
  Vector3d rate;
};

void PrintTo(const Case& body, std::ostream* out) {
  *out << body.name;
}

const Case kBodies[] = {
    {"AboutTheLargest", {1.0, 2.0, 2.5}, {0.1, 0.2, 1.0}},
    {"AboutTheSmallest", {1.0, 2.0, 2.5}, {-1.0, 0.2, 0.1}},
    {"OtherOrderOfAxes", {2.5, 1.0, 2.0}, {0.3, -0.7, 0.4}},
    {"ThirdOrderOfAxes", {2.0, 2.5, 1.0}, {-0.3, -0.9, 0.2}},
    {"NearTheMiddleAxis", {1.0, 2.0, 2.5}, {1e-6, 1.0, 1e-6}},
    {"OnTheSeparatrix", {1.0, 2.0, 3.0}, {0.3, 0.5, 0.1 * std::sqrt(3.0)}},
    {"Oblate", {2.0, 2.0, 3.0}, {0.2, 0.3, 0.9}},
    {"Prolate", {1.0, 3.0, 3.0}, {0.2, 0.3, -0.9}},
    {"NearlySpherical", {1.0, 1.0 + 1e-9, 1.0 + 2e-9}, {1.0, 1.0, 1.0}},
    {"NearlyAboutAnAxis", {1.0, 2.0, 2.5}, {0.0, 1e-12, 2.0}},
    {"ThinPlate", {1.0, 2.0, 3.0}, {0.4, 0.1, -0.3}},
};

class TumblingBody : public ::testing::TestWithParam<Case> {
 protected:
  static InitialRotation start() {
    InitialRotation start{.moments_kg_m2 = GetParam().moments, .rate_rad_s = GetParam().rate};
    start.world_from_body =
        make_pose({1.0, 2.0, 3.0}, Eigen::Quaterniond(0.4, -0.2, 0.7, 0.1).normalized());
    return start;
  }
};

Vector3d momentum(const TorqueFreeRotation& body, std::int64_t t_ns) {
  const Vector3d along_axes = body.start().moments_kg_m2.cwiseProduct(body.rate_at(t_ns));
  return body.pose_at(t_ns).linear() * along_axes;
}

double energy(const TorqueFreeRotation& body, std::int64_t t_ns) {
  const Vector3d w = body.rate_at(t_ns);
  return 0.5 * w.dot(body.start().moments_kg_m2.cwiseProduct(w));
}

TEST_P(TumblingBody, KeepsAngularMomentumAndEnergyForADay) {
  const TorqueFreeRotation body(start());
  const Vector3d l = momentum(body, 0);
  const double e = energy(body, 0);
  for (std::int64_t t = 0; t < 86400 * kSecond_ns; t += 61 * kSecond_ns + 987654321) {
    // closed form: the requirement is 1e-9, the error is rounding
    ASSERT_LT((momentum(body, t) - l).norm(), 1e-12 * l.norm()) << t;
    ASSERT_NEAR(energy(body, t), e, 1e-12 * e) << t;
    ASSERT_TRUE(is_rigid(body.pose_at(t), 1e-13));
  }
}

TEST_P(TumblingBody, StartsWithThePoseAndRateGiven) {
  const TorqueFreeRotation body(start());
  EXPECT_LT((body.pose_at(0).matrix() - start().world_from_body.matrix()).norm(), 1e-12);
  EXPECT_LT((body.rate_at(0) - GetParam().rate).norm(), 1e-12);
}

/// Quaternion (w, x, y, z) and rates.
using State = std::array<double, 7>;

State slope(const Vector3d& moments, const State& s) {
  const Eigen::Quaterniond q(s[0], s[1], s[2], s[3]);
  const Vector3d w(s[4], s[5], s[6]);
  const Eigen::Quaterniond dq = q * Eigen::Quaterniond(0.0, w.x(), w.y(), w.z());
  const Vector3d dw = moments.cwiseProduct(w).cross(w).cwiseQuotient(moments);
  return {0.5 * dq.w(), 0.5 * dq.x(), 0.5 * dq.y(), 0.5 * dq.z(), dw.x(), dw.y(), dw.z()};
}

/// The classical method of Runge and Kutta.
State step(const Vector3d& moments, const State& s, double h) {
  const auto moved = [&](const State& k, double by) {
    State out = s;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += by * k[i];
    return out;
  };
  const State k1 = slope(moments, s);
  const State k2 = slope(moments, moved(k1, h / 2));
  const State k3 = slope(moments, moved(k2, h / 2));
  const State k4 = slope(moments, moved(k3, h));
  State out = s;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
  }
  return out;
}

TEST_P(TumblingBody, FollowsEulersEquationsIntegratedStepByStep) {
  const TorqueFreeRotation body(start());
  const Eigen::Quaterniond q(start().world_from_body.linear());
  const Vector3d w = GetParam().rate;
  State s = {q.w(), q.x(), q.y(), q.z(), w.x(), w.y(), w.z()};
  for (int second = 1; second <= 20; ++second) {
    for (int i = 0; i < 1000; ++i) s = step(GetParam().moments, s, 1e-3);
    const Pose pose = body.pose_at(second * kSecond_ns);
    const Eigen::Matrix3d expected =
        Eigen::Quaterniond(s[0], s[1], s[2], s[3]).normalized().toRotationMatrix();
    // steps of 1e-3: errors of 1e-13 each second, and of rounding; near the middle axis they grow
    // as e^(0.45 t), by 1e4
    ASSERT_LT((pose.linear() - expected).norm(), 1e-8) << second;
    ASSERT_LT((body.rate_at(second * kSecond_ns) - Vector3d(s[4], s[5], s[6])).norm(), 1e-8)
        << second;
  }
}

TEST_P(TumblingBody, IsIndependentOfTheOrderOfQueries) {
  const TorqueFreeRotation body(start());
  const Pose before = body.pose_at(12345678901);
  (void)body.pose_at(99);
  EXPECT_EQ(before.matrix(), body.pose_at(12345678901).matrix());
  EXPECT_EQ(before.matrix(), TorqueFreeRotation(start()).pose_at(12345678901).matrix());
}

INSTANTIATE_TEST_SUITE_P(Bodies, TumblingBody, ::testing::ValuesIn(kBodies),
                         [](const auto& body) { return std::string(body.param.name); });

TEST(TorqueFreeRotation, SymmetricBodyNutatesAndPrecessesAtItsTextbookRates) {
  // Goldstein, "Classical Mechanics" (3rd ed.), section 5.6: the rate along the axis stays, the
  // rate across turns about the axis at (I3 - I1) / I1 w3, the axis turns about L at L / I1
  const Vector3d moments(2.0, 2.0, 3.0);
  const Vector3d rate(0.3, 0.0, 1.2);
  const TorqueFreeRotation body({.moments_kg_m2 = moments, .rate_rad_s = rate});
  const double nutation = (3.0 - 2.0) / 2.0 * 1.2;
  const Vector3d l = moments.cwiseProduct(rate);
  for (int i = 0; i < 500; ++i) {
    const std::int64_t t_ns = i * 123'456'789LL;
    const double t = static_cast<double>(t_ns) / 1e9;
    const Vector3d expected(0.3 * std::cos(nutation * t), 0.3 * std::sin(nutation * t), 1.2);
    ASSERT_LT((body.rate_at(t_ns) - expected).norm(), 1e-12);
    const Eigen::AngleAxisd precession(l.norm() / 2.0 * t, l.normalized());
    const Vector3d axis = body.pose_at(t_ns).linear() * Vector3d::UnitZ();
    ASSERT_LT((axis - precession * Vector3d::UnitZ()).norm(), 1e-12);
    const Eigen::AngleAxisd own(-nutation * t, Vector3d::UnitZ());
    ASSERT_LT((body.pose_at(t_ns).linear() - (precession * own).toRotationMatrix()).norm(), 1e-12);
  }
}

TEST(TorqueFreeRotation, FlipsPeriodicallyAboutTheIntermediateAxis) {
  const double small = 1e-3;
  const TorqueFreeRotation body(
      {.moments_kg_m2 = {1.0, 2.0, 2.5}, .rate_rad_s = {0.0, 1.0, small}});
  // Landau & Lifshitz (37.8) to (37.12) with L^2 > 2 E I2: the rate about the middle axis is sn, at
  // its peak at the start; it passes zero every 2 K
  const double below = 2.0 * (2.5 - 2.0);                              // 2 E I3 - L^2
  const double above = 2.0 * (2.0 - 1.0) + 2.5 * 1.5 * small * small;  // L^2 - 2 E I1
  const double m = (2.0 - 1.0) * below / ((2.5 - 2.0) * above);
  const double rate = std::sqrt((2.5 - 2.0) * above / (1.0 * 2.0 * 2.5));
  const double half_period_s = 2.0 * std::comp_ellint_1(std::sqrt(m)) / rate;
  const auto middle_rate = [&](double t_s) {
    return body.rate_at(static_cast<std::int64_t>(t_s * 1e9)).y();
  };
  for (int flip = 0; flip < 20; ++flip) {
    const double sign = flip % 2 == 0 ? 1.0 : -1.0;
    EXPECT_NEAR(middle_rate(flip * half_period_s), sign, 1e-9);
    // m is 1 - 4e-6, of which the standard library's k knows ten digits
    EXPECT_NEAR(middle_rate((flip + 0.5) * half_period_s), 0.0, 1e-7);
    EXPECT_GT(sign * middle_rate((flip + 0.5) * half_period_s - 0.01), 0.0);
    EXPECT_LT(sign * middle_rate((flip + 0.5) * half_period_s + 0.01), 0.0);
  }
}

TEST(TorqueFreeRotation, RotatesSteadilyAboutEachPrincipalAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d rate = 0.7 * Vector3d::Unit(axis);
    const TorqueFreeRotation body({.moments_kg_m2 = {1.0, 2.0, 2.5}, .rate_rad_s = rate});
    const Eigen::AngleAxisd expected(0.7 * 3.0, Vector3d::Unit(axis));
    EXPECT_LT((body.pose_at(3 * kSecond_ns).linear() - expected.toRotationMatrix()).norm(), 1e-14);
    EXPECT_EQ(body.rate_at(86400 * kSecond_ns), rate);
  }
}

TEST(TorqueFreeRotation, CentreOfMassMovesStraight) {
  InitialRotation start{.moments_kg_m2 = {1.0, 2.0, 2.5}, .rate_rad_s = {0.1, 0.2, 1.0}};
  start.world_from_body = make_pose({5.0, 6.0, 7.0}, Eigen::Quaterniond(0.6, 0.0, 0.8, 0.0));
  start.body_from_principal = make_pose({0.5, 0.1, -0.2}, Eigen::Quaterniond(0.8, 0.6, 0.0, 0.0));
  start.velocity_m_s = {0.1, -0.2, 0.3};
  const TorqueFreeRotation body(start);
  const Vector3d centre = start.body_from_principal.translation();
  const Vector3d from = start.world_from_body * centre;
  for (int t = 0; t < 50; ++t) {
    const Vector3d now = body.pose_at(t * kSecond_ns) * centre;
    EXPECT_LT((now - from - t * start.velocity_m_s).norm(), 1e-12);
  }
}

/// One row of the reference: a body, a time, and its attitude and rates then.
struct Reference {
  InitialRotation start;
  std::int64_t t_ns = 0;
  Eigen::Quaterniond attitude;
  Vector3d rate;
};

Reference parse_reference(const std::string& line) {
  std::istringstream words(line);
  std::vector<double> numbers;
  std::int64_t t_ns = 0;
  for (std::string word; std::getline(words, word, ',');) {
    if (numbers.size() == 6 && t_ns == 0) {
      t_ns = std::stoll(word);
    } else {
      numbers.push_back(std::strtod(word.c_str(), nullptr));  // reads subnormal numbers too
    }
  }
  EXPECT_EQ(numbers.size(), 13U) << line;
  numbers.resize(13);
  return {.start = {.moments_kg_m2 = {numbers[0], numbers[1], numbers[2]},
                    .rate_rad_s = {numbers[3], numbers[4], numbers[5]}},
          .t_ns = t_ns,
          .attitude = {numbers[6], numbers[7], numbers[8], numbers[9]},
          .rate = {numbers[10], numbers[11], numbers[12]}};
}

/// The largest component's share of the whole, for errors of all.
double relative_error(const Vector3d& found, const Vector3d& expected) {
  return (found - expected).norm() / expected.norm();
}

// 1e-13, and of the angle turned a few roundings: rates and times are doubles.
TEST(TorqueFreeRotation, IsExactNearEveryAxis) {
  std::ifstream file(std::string(kSourceFolder) + "/tests/motion/tumbling_reference.csv");
  std::size_t rows = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    ++rows;
    const Reference reference = parse_reference(line);
    const TorqueFreeRotation body(reference.start);
    const double turned =
        reference.start.rate_rad_s.stableNorm() * static_cast<double>(reference.t_ns) / 1e9;
    const double tolerance = 1e-13 + 1e-15 * turned;
    const Eigen::Matrix3d found = body.pose_at(reference.t_ns).linear();
    EXPECT_LT((found - reference.attitude.toRotationMatrix()).norm(), tolerance) << line;
    EXPECT_LT((body.rate_at(reference.t_ns) - reference.rate).stableNorm(),
              tolerance * reference.start.rate_rad_s.stableNorm())
        << line;
  }
  EXPECT_GT(rows, 150U);
}

TEST(TorqueFreeRotation, TinyOffAxisRatesChangeNothing) {
  // 0.5 rad about an axis of equal moments; off-axis rates as small as roundings once made it 1.28
  for (const double off : {0.0, 1e-300, 1e-60, 6.1e-18, 1e-15, 1e-12}) {
    const TorqueFreeRotation body(
        {.moments_kg_m2 = {10.0, 10.0, 1.0}, .rate_rad_s = {0.1, 0.0, off}});
    const Eigen::AngleAxisd turn(body.pose_at(5 * kSecond_ns).linear());
    EXPECT_NEAR(turn.angle(), 0.5, 1e-13 + 5.0 * off) << off;
  }
}

/// Of unit vectors that cover the sphere evenly, a Fibonacci lattice.
Vector3d direction(int k, int count) {
  const double z = 1.0 - (2.0 * k + 1.0) / count;
  const double angle = k * std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

TEST(TorqueFreeRotation, ConservesMomentumAndEnergyForAllAxesAndRates) {
  constexpr int kDirections = 300;
  for (const Case& shape : kBodies) {
    for (int k = 0; k < kDirections; ++k) {
      const double size = std::pow(10.0, -12.0 + 13.0 * (k % 14) / 13.0);  // to 10 rad/s
      const TorqueFreeRotation body(
          {.moments_kg_m2 = shape.moments, .rate_rad_s = size * direction(k, kDirections)});
      const Vector3d l = momentum(body, 0);
      const double e = energy(body, 0);
      for (const std::int64_t t : {kSecond_ns / 3, 77 * kSecond_ns, 1'000'000 * kSecond_ns}) {
        ASSERT_LT(relative_error(momentum(body, t), l), 1e-13) << shape.name << k << " " << t;
        ASSERT_NEAR(energy(body, t) / e, 1.0, 1e-13) << shape.name << k << " " << t;
        ASSERT_TRUE(is_rigid(body.pose_at(t), 1e-14));
      }
    }
  }
}

// The angular velocity is the derivative of the attitude: what momentum and energy do not see.
TEST(TorqueFreeRotation, AttitudeChangesAtTheRate) {
  constexpr std::int64_t kStep_ns = 1'000'000;
  for (const Case& shape : kBodies) {
    for (int k = 0; k < 60; ++k) {
      const TorqueFreeRotation body(
          {.moments_kg_m2 = shape.moments, .rate_rad_s = direction(k, 60)});
      const std::int64_t t = k * kSecond_ns / 7;
      const Eigen::Matrix3d step =
          body.pose_at(t - kStep_ns).linear().transpose() * body.pose_at(t + kStep_ns).linear();
      const Eigen::AngleAxisd turn(step);
      // the middle rule: errors of the third order of 1e-3
      ASSERT_LT((turn.angle() * turn.axis() / 2e-3 - body.rate_at(t)).norm(), 2e-6)
          << shape.name << k;
    }
  }
}

TEST(TorqueFreeRotation, RejectsImpossibleMomentsOfInertia) {
  EXPECT_THROW(TorqueFreeRotation({.moments_kg_m2 = {1.0, 1.0, 2.1}}), Error);
  EXPECT_THROW(TorqueFreeRotation({.moments_kg_m2 = {1.0, 0.0, 1.0}}), Error);
  EXPECT_THROW(TorqueFreeRotation({.moments_kg_m2 = {1.0, 1.0, std::nan("")}}), Error);
  EXPECT_THROW(TorqueFreeRotation({.rate_rad_s = {0.0, 0.0, INFINITY}}), Error);
  EXPECT_NO_THROW(TorqueFreeRotation({.moments_kg_m2 = {1.0, 1.0, 2.0}}));
}

TEST(IntegralTable, IntegratesSmoothFunctionsToRounding) {
  // the pole nearest to the real axis is at a distance of pi / 2, as that of sech
  const auto sech = [](double x) { return 1.0 / std::cosh(x); };
  for (const double end : {0.1, 1.0, 1.7, 40.3}) {
    const IntegralTable table(end, FunctionRef<double(double)>(sech));
    for (int k = 0; k <= 100; ++k) {
      const double x = end * k / 100;
      EXPECT_NEAR(table.at(x), std::atan(std::sinh(x)), 2e-15) << end << " " << x;
    }
    EXPECT_NEAR(table.total(), std::atan(std::sinh(end)), 2e-15);
  }
}

TEST(IntegralTable, IsZeroAtTheStart) {
  const auto one = [](double) { return 1.0; };
  EXPECT_NEAR(IntegralTable(3.0, FunctionRef<double(double)>(one)).at(0.0), 0.0, 1e-16);
}

constexpr double kRounding = 4e-15;  // relative; a dozen roundings

TEST(Elliptic, CarlsonsIntegralHasThePublishedValues) {
  // Carlson, "Numerical computation of real or complex elliptic integrals" (1995), section 3
  EXPECT_NEAR(carlson_rf(1.0, 2.0, 0.0), 1.3110287771461, 5e-14);
  EXPECT_NEAR(carlson_rf(2.0, 3.0, 4.0), 0.58408284167715, 5e-15);
}

TEST(Elliptic, CompleteIntegralAgreesWithTheStandardLibrary) {
  for (const double m : {0.0, 0.01, 0.3, 0.5, 0.9, 0.99}) {
    const double expected = std::comp_ellint_1(std::sqrt(m));
    EXPECT_NEAR(make_modulus(m, 1.0 - m).quarter_period, expected, 1e-13 * expected) << m;
  }
}

TEST(Elliptic, QuarterPeriodNearOneIsTheLogarithm) {
  // K = ln(4 / sqrt(m1)) + O(m1 ln m1), Abramowitz & Stegun 17.3.26
  EXPECT_NEAR(make_modulus(1.0, 1e-30).quarter_period, std::log(4e15), 1e-13);
}

TEST(Elliptic, JacobiFunctionsInvertTheFirstIntegral) {
  for (const double m : {0.0, 0.2, 0.7, 0.999}) {
    const EllipticModulus modulus = make_modulus(m, 1.0 - m);
    for (double angle = -3.1; angle < 3.1; angle += 0.1) {
      const JacobiValues j = jacobi(modulus, elliptic_f(modulus, std::sin(angle), std::cos(angle)));
      EXPECT_NEAR(j.sn, std::sin(angle), kRounding * 10.0) << m << " " << angle;
      EXPECT_NEAR(j.cn, std::cos(angle), kRounding * 10.0) << m << " " << angle;
      EXPECT_NEAR(j.dn * j.dn, 1.0 - m * j.sn * j.sn, kRounding);
    }
  }
}

TEST(Elliptic, JacobiFunctionsHaveTheirLimits) {
  const EllipticModulus circle = make_modulus(0.0, 1.0);
  const EllipticModulus separatrix = make_modulus(1.0, 1e-30);
  for (double u = -5.0; u < 5.0; u += 0.37) {
    EXPECT_NEAR(jacobi(circle, u).sn, std::sin(u), kRounding);
    // the mean takes more steps there, each with its rounding
    EXPECT_NEAR(jacobi(separatrix, u).sn, std::tanh(u), 5.0 * kRounding);
    EXPECT_NEAR(jacobi(separatrix, u).cn, 1.0 / std::cosh(u), 5.0 * kRounding);
    EXPECT_NEAR(jacobi(separatrix, u).dn, 1.0 / std::cosh(u), 5.0 * kRounding);
  }
}

TEST(Elliptic, FirstIntegralAgreesWithTheStandardLibrary) {
  for (const double m : {0.1, 0.5, 0.9}) {
    const EllipticModulus modulus = make_modulus(m, 1.0 - m);
    for (double angle = -1.5; angle < 1.6; angle += 0.25) {
      const double u = std::ellint_1(std::sqrt(m), angle);
      EXPECT_NEAR(elliptic_f(modulus, std::sin(angle), std::cos(angle)), u, 1e-13);
    }
  }
}

// Relative, where cn and dn are as small as sqrt(1 - m):
// cn(K + x) = -k' sn / dn, dn(K + x) = k' / dn (DLMF 22.4(iii)), with tanh and sech for m near 1.
TEST(Elliptic, SmallValuesKeepTheirRelativePrecision) {
  for (const double complement : {1e-40, 1e-80, 1e-250}) {
    const EllipticModulus modulus = make_modulus(1.0, complement);
    const double root = std::sqrt(complement);
    const double quarter = modulus.quarter_period;
    for (const double x : {0.5, 1.0, 3.0, 10.0}) {
      // the quarter period itself is rounded
      const double tolerance = 1e-13 + quarter * 1e-15;
      const JacobiValues j = jacobi(modulus, quarter + x);
      EXPECT_NEAR(j.cn / (-root * std::sinh(x)), 1.0, tolerance) << complement << " " << x;
      EXPECT_NEAR(j.dn / (root * std::cosh(x)), 1.0, tolerance) << complement << " " << x;
    }
  }
}

TEST(Elliptic, FunctionsArePeriodic) {
  for (const double m : {0.0, 0.3, 0.500001, 0.97}) {
    const EllipticModulus modulus = make_modulus(m, 1.0 - m);
    const double period = 4.0 * modulus.quarter_period;
    for (double u = -3.0; u < 3.0; u += 0.31) {
      const JacobiValues one = jacobi(modulus, u);
      const JacobiValues far = jacobi(modulus, u + 25.0 * period);
      // of arguments up to 300, rounded
      EXPECT_NEAR(one.sn, far.sn, 1e-13);
      EXPECT_NEAR(one.cn, far.cn, 1e-13);
      EXPECT_NEAR(one.dn, far.dn, 1e-13);
      EXPECT_NEAR(one.sn * one.sn + one.cn * one.cn, 1.0, kRounding);
    }
  }
}

}  // namespace

}  // namespace glidar
