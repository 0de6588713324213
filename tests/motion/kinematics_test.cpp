// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/kinematics.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace glidar {
namespace {

using Eigen::Vector3d;
using LongVector = Eigen::Matrix<long double, 3, 1>;
using LongMatrix = Eigen::Matrix<long double, 3, 3>;

constexpr double kPi = std::numbers::pi;

Pose some_pose() {
  return make_pose({3.0, -2.0, 1.5}, Eigen::Quaterniond(0.6, 0.4, -0.5, 0.3));
}

Pose lever_arm() {
  return make_pose({0.4, -0.3, 0.8}, Eigen::Quaterniond(0.9, -0.1, 0.2, 0.3));
}

/// A smooth motion, sampled.
TimedPoses sampled(Interpolation interpolation, std::size_t count = 40) {
  std::vector<TimedPose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = 0.1 * static_cast<double>(i) + 0.01 * std::sin(2.0 * static_cast<double>(i));
    const Vector3d axis = Vector3d(std::sin(t), std::cos(1.3 * t), 0.4).normalized();
    poses.push_back({.t_ns = std::llround(t * 1e9),
                     .position_m = {std::cos(t), 2.0 * std::sin(0.7 * t), 0.1 * t * t},
                     .orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.8 * t, axis))});
  }
  return TimedPoses(std::move(poses), interpolation);
}

TorqueFreeRotation tumbling() {
  return TorqueFreeRotation({.moments_kg_m2 = {1.0, 2.0, 2.5},
                             .rate_rad_s = {0.3, 1.2, 0.2},
                             .world_from_body = some_pose(),
                             .body_from_principal = lever_arm(),
                             .velocity_m_s = {0.5, -1.0, 0.2}});
}

struct NamedTrajectory {
  std::string name;
  Trajectory trajectory;
};

std::vector<NamedTrajectory> all_kinds() {
  const ConstantTwist body = {
      .pose = some_pose(), .angular_rad_s = {0.3, -0.8, 0.5}, .linear_m_s = {1.0, 2.0, -0.5}};
  ConstantTwist world = body;
  world.frame = TwistFrame::world;
  const TorqueFreeRotation steady({.rate_rad_s = {0.0, 0.0, 1.5},
                                   .world_from_body = some_pose(),
                                   .body_from_principal = lever_arm()});
  std::vector<NamedTrajectory> kinds = {
      {"constant", ConstantPose{some_pose()}},
      {"twist in the body", body},
      {"twist in the world", world},
      {"spin", Spin{.pose = some_pose(), .rate_rad_s = {0.2, 1.1, -0.7}}},
      {"linear", sampled(Interpolation::linear)},
      {"spline", sampled(Interpolation::spline)},
      {"tumbling", tumbling()},
      {"steady tumbling", steady}};
  const std::size_t count = kinds.size();
  for (std::size_t i = 0; i < count; ++i) {
    kinds.push_back(
        {kinds[i].name + ", mounted", compose_extrinsic(kinds[i].trajectory, lever_arm())});
  }
  return kinds;
}

/// Derivatives of the poses by differences of the fourth order, in long double.
struct Differences {
  explicit Differences(const Trajectory& trajectory, std::int64_t t_ns) {
    constexpr std::int64_t kStep_ns = 2'000'000;
    const long double h = 2e-3L;
    LongVector p[5];
    LongMatrix r[5];
    for (int k = 0; k < 5; ++k) {
      const Pose pose = pose_at(trajectory, t_ns + (k - 2) * kStep_ns);
      p[k] = pose.translation().cast<long double>();
      r[k] = pose.linear().cast<long double>();
    }
    velocity = (p[0] - 8.0L * p[1] + 8.0L * p[3] - p[4]) / (12.0L * h);
    acceleration = (-p[0] + 16.0L * p[1] - 30.0L * p[2] + 16.0L * p[3] - p[4]) / (12.0L * h * h);
    const LongMatrix slope = (r[0] - 8.0L * r[1] + 8.0L * r[3] - r[4]) / (12.0L * h);
    const LongMatrix curvature =
        (-r[0] + 16.0L * r[1] - 30.0L * r[2] + 16.0L * r[3] - r[4]) / (12.0L * h * h);
    // R' = R [w] and R'' = R ([w]^2 + [w'])
    rate = vee(r[2].transpose() * slope);
    rate_change = vee(r[2].transpose() * curvature);
  }

  /// The vector of the antisymmetric part.
  static LongVector vee(const LongMatrix& m) {
    return 0.5L * LongVector(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
  }

  LongVector velocity;
  LongVector acceleration;
  LongVector rate;
  LongVector rate_change;
};

double distance(const LongVector& found, const Vector3d& expected) {
  return static_cast<double>((found - expected.cast<long double>()).norm());
}

TEST(Kinematics, DerivativesAgreeWithDifferencesOfPosesForEveryTrajectory) {
  constexpr double kFirst = 1e-8;   // truncation of the differences
  constexpr double kSecond = 1e-7;  // and rounding of poses, 1e-16 / h^2
  for (const NamedTrajectory& one : all_kinds()) {
    for (const std::int64_t t_ns :
         std::vector<std::int64_t>{950'000'000, 1'234'000'000, 2'950'000'000}) {
      const KinematicState state = state_at(one.trajectory, t_ns);
      const Differences differences(one.trajectory, t_ns);
      EXPECT_EQ(state.pose.matrix(), pose_at(one.trajectory, t_ns).matrix()) << one.name;
      EXPECT_LT(distance(differences.velocity, state.velocity_m_s), kFirst) << one.name;
      EXPECT_LT(distance(differences.acceleration, state.acceleration_m_s2), kSecond) << one.name;
      EXPECT_LT(distance(differences.rate, state.angular_velocity_rad_s), kFirst) << one.name;
      EXPECT_LT(distance(differences.rate_change, state.angular_acceleration_rad_s2), kSecond)
          << one.name;
    }
  }
}

TEST(Kinematics, LeverArmOnASpinHasCentripetalAcceleration) {
  const Trajectory arm =
      compose_extrinsic(Spin{.pose = Pose::Identity(), .rate_rad_s = {0.0, 0.0, 2.0}},
                        make_pose({3.0, 0.0, 1.0}, Eigen::Quaterniond::Identity()));
  const KinematicState state = state_at(arm, 0);
  EXPECT_LT((state.velocity_m_s - Vector3d(0.0, 6.0, 0.0)).norm(), 1e-14);
  EXPECT_LT((state.acceleration_m_s2 - Vector3d(-12.0, 0.0, 0.0)).norm(), 1e-14);
}

TEST(Kinematics, LeverArmHasTangentialAcceleration) {
  const KinematicState body = {.angular_velocity_rad_s = {0.0, 0.0, 2.0},
                               .angular_acceleration_rad_s2 = {0.0, 0.0, 5.0}};
  const KinematicState part =
      compose_extrinsic(body, make_pose({3.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()));
  EXPECT_EQ(part.acceleration_m_s2, Vector3d(-12.0, 15.0, 0.0));
}

TEST(Kinematics, CentreOfMassOfAFreeBodyIsNotAccelerated) {
  const Trajectory centre = compose_extrinsic(tumbling(), lever_arm());
  const KinematicState state = state_at(centre, 1'700'000'000);
  EXPECT_LT(state.acceleration_m_s2.norm(), 1e-13);
  EXPECT_LT((state.velocity_m_s - Vector3d(0.5, -1.0, 0.2)).norm(), 1e-13);
}

TEST(Kinematics, ConstantTwistMovesOnACircleAtConstantSpeed) {
  const ConstantTwist twist = {.angular_rad_s = {0.0, 0.0, 0.5}, .linear_m_s = {2.0, 0.0, 0.0}};
  const KinematicState state = state_at(twist, std::llround(kPi * 1e9));  // a quarter turn
  EXPECT_LT((state.velocity_m_s - Vector3d(0.0, 2.0, 0.0)).norm(), 1e-8);
  EXPECT_LT((state.acceleration_m_s2 - Vector3d(-1.0, 0.0, 0.0)).norm(), 1e-8);
}

TEST(PoseSpline, PassesThroughThePosesExactly) {
  const TimedPoses spline = sampled(Interpolation::spline);
  const TimedPoses linear = sampled(Interpolation::linear);
  for (const TimedPose& pose : spline.poses()) {
    EXPECT_EQ(spline.pose_at(pose.t_ns).matrix(), linear.pose_at(pose.t_ns).matrix());
    const Pose before = spline.pose_at(pose.t_ns - 1);
    EXPECT_LT((before.matrix() - linear.pose_at(pose.t_ns).matrix()).norm(), 1e-8);
  }
}

TEST(PoseSpline, SecondDerivativesAreContinuousAtThePoses) {
  const TimedPoses spline = sampled(Interpolation::spline);
  for (std::size_t i = 1; i + 1 < spline.poses().size(); ++i) {
    const std::int64_t t_ns = spline.poses()[i].t_ns;
    const KinematicState before = spline.state_at(t_ns - 1);
    const KinematicState after = spline.state_at(t_ns);
    EXPECT_LT((before.velocity_m_s - after.velocity_m_s).norm(), 1e-7) << i;
    EXPECT_LT((before.acceleration_m_s2 - after.acceleration_m_s2).norm(), 1e-6) << i;
    EXPECT_LT((before.angular_velocity_rad_s - after.angular_velocity_rad_s).norm(), 1e-7) << i;
    EXPECT_LT((before.angular_acceleration_rad_s2 - after.angular_acceleration_rad_s2).norm(), 1e-6)
        << i;
  }
}

TEST(PoseSpline, EndsWithoutAcceleration) {
  const TimedPoses spline = sampled(Interpolation::spline);
  for (const std::int64_t t_ns : {spline.first_ns(), spline.last_ns()}) {
    const KinematicState state = spline.state_at(t_ns);
    EXPECT_LT(state.acceleration_m_s2.norm(), 1e-11);
    EXPECT_LT(state.angular_acceleration_rad_s2.norm(), 1e-11);
    EXPECT_GT(state.velocity_m_s.norm(), 0.1);
  }
}

TEST(PoseSpline, OfTwoPosesIsLinear) {
  const TimedPoses spline = sampled(Interpolation::spline, 2);
  const TimedPoses linear = sampled(Interpolation::linear, 2);
  const std::int64_t t_ns = spline.last_ns() / 3;
  EXPECT_LT((spline.pose_at(t_ns).matrix() - linear.pose_at(t_ns).matrix()).norm(), 1e-14);
}

TEST(PoseSpline, OfOnePoseIsConstant) {
  const TimedPoses spline({{.t_ns = 5, .position_m = {1.0, 2.0, 3.0}}}, Interpolation::spline);
  EXPECT_EQ(spline.pose_at(9).translation(), Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(spline.state_at(5).velocity_m_s, Vector3d::Zero());
}

TEST(PoseSpline, IsNearTheMotionThatWasSampled) {
  const TimedPoses spline = sampled(Interpolation::spline);
  const double t = 2.013;
  const KinematicState state = spline.state_at(std::llround(t * 1e9));
  EXPECT_LT((state.pose.translation() - Vector3d(std::cos(t), 2.0 * std::sin(0.7 * t), 0.1 * t * t))
                .norm(),
            1e-6);
  EXPECT_LT((state.acceleration_m_s2 - Vector3d(-std::cos(t), -2.0 * 0.49 * std::sin(0.7 * t), 0.2))
                .norm(),
            3e-3);
}

TEST(PoseSpline, SurvivesTransformationAndMounting) {
  const TimedPoses spline = sampled(Interpolation::spline);
  const Trajectory moved = transformed(some_pose(), spline);
  const Pose expected = some_pose() * spline.pose_at(1'234'567'890);
  EXPECT_LT((pose_at(moved, 1'234'567'890).matrix() - expected.matrix()).norm(), 1e-12);
  EXPECT_EQ(std::get<TimedPoses>(moved).interpolation(), Interpolation::spline);
}

/// Half turns about axes that alternate are the largest rotations that two poses can have.
TEST(PoseSpline, AcceptsLargeRotationsBetweenPoses) {
  std::vector<TimedPose> poses;
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  for (std::int64_t i = 0; i < 12; ++i) {
    poses.push_back({.t_ns = i * 1'000'000'000, .orientation = orientation});
    const Vector3d axis = i % 2 == 0 ? Vector3d::UnitX() : Vector3d(0.0, 0.6, 0.8);
    orientation = (orientation * Eigen::Quaterniond(Eigen::AngleAxisd(2.5, axis))).normalized();
  }
  const TimedPoses spline(std::move(poses), Interpolation::spline);
  const KinematicState before = spline.state_at(4'999'999'999);
  const KinematicState after = spline.state_at(5'000'000'000);
  EXPECT_LT((before.angular_acceleration_rad_s2 - after.angular_acceleration_rad_s2).norm(), 1e-6);
  EXPECT_TRUE(is_rigid(spline.pose_at(4'400'000'000), 1e-12));
}

TEST(TimedPoses, LinearlyInterpolatedStartANewVelocityAtEveryPose) {
  const TimedPoses linear({{.t_ns = 0},
                           {.t_ns = 1'000'000'000, .position_m = {1.0, 0.0, 0.0}},
                           {.t_ns = 2'000'000'000, .position_m = {1.0, 3.0, 0.0}}});
  EXPECT_EQ(linear.state_at(999'999'999).velocity_m_s, Vector3d(1.0, 0.0, 0.0));
  EXPECT_EQ(linear.state_at(1'000'000'000).velocity_m_s, Vector3d(0.0, 3.0, 0.0));
  EXPECT_EQ(linear.state_at(2'000'000'000).velocity_m_s, Vector3d(0.0, 3.0, 0.0));
  EXPECT_EQ(linear.state_at(2'000'000'001).velocity_m_s, Vector3d::Zero());
  EXPECT_EQ(linear.state_at(-1).velocity_m_s, Vector3d::Zero());
}

TEST(TimedPoses, AreReportedWhenInertialSensorsReadThemLinearly) {
  std::string warning;
  const Report report = {
      [&](Severity /*severity*/, std::string_view text) { warning = std::string(text); }, {}};
  warn_linear_interpolation(sampled(Interpolation::spline), "imu", report);
  warn_linear_interpolation(tumbling(), "imu", report);
  EXPECT_EQ(warning, "");
  warn_linear_interpolation(compose_extrinsic(sampled(Interpolation::linear), lever_arm()), "imu",
                            report);
  EXPECT_NE(warning.find("interpolation: spline"), std::string::npos) << warning;
}

TEST(MaxDisplacement, EnclosesTheMotionOfAPointOfEveryKind) {
  const Vector3d point_m(0.7, -1.2, 0.4);
  for (const NamedTrajectory& kind : all_kinds()) {
    for (const std::int64_t first_ns : {-100'000'000LL, 50'000'000LL, 1'234'567'891LL}) {
      for (const std::int64_t duration_ns : {1'000LL, 7'000'000LL, 400'000'000LL}) {
        const TimeInterval interval{first_ns, first_ns + duration_ns};
        const std::int64_t middle_ns = first_ns + duration_ns / 2;
        const double bound_m = max_displacement_m(kind.trajectory, point_m, middle_ns, interval);
        const Vector3d middle_m = pose_at(kind.trajectory, middle_ns) * point_m;
        double farthest_m = 0.0;
        constexpr std::int64_t kSamples = 64;
        for (std::int64_t i = 0; i <= kSamples; ++i) {
          const Pose pose = pose_at(kind.trajectory, first_ns + i * duration_ns / kSamples);
          farthest_m = std::max(farthest_m, (pose * point_m - middle_m).norm());
        }
        constexpr double kPoseRounding_m = 1e-14;
        EXPECT_LE(farthest_m, bound_m + kPoseRounding_m) << kind.name << " from " << first_ns;
        if (duration_ns == 7'000'000 && first_ns > 0) {
          EXPECT_LE(bound_m, 4.0 * farthest_m + kPoseRounding_m) << kind.name << ": too loose";
        }
      }
    }
  }
}

TEST(MaxDisplacement, IsThatOfTheFastestIntervalOfLinearPoses) {
  std::vector<TimedPose> poses;
  for (const double x_m : {0.0, 1.0, 1.0, 4.0}) {
    poses.push_back({.t_ns = static_cast<std::int64_t>(poses.size()) * 1'000'000'000,
                     .position_m = {x_m, 0.0, 0.0}});
  }
  const Trajectory path = TimedPoses(poses);
  const auto bound_m = [&](std::int64_t first_ms, std::int64_t last_ms) {
    constexpr std::int64_t kMillisecond_ns = 1'000'000;
    return max_displacement_m(path, {0, 0, 0}, first_ms * kMillisecond_ns,
                              {first_ms * kMillisecond_ns, last_ms * kMillisecond_ns});
  };
  constexpr double kRounding = 2e-5;  // a step of the clock at 3 m/s
  EXPECT_NEAR(bound_m(100, 200), 0.1, kRounding);
  EXPECT_NEAR(bound_m(1'100, 1'900), 0.0, kRounding);
  EXPECT_NEAR(bound_m(1'900, 2'100), 0.6, kRounding) << "0.2 s at 3 m/s";
  EXPECT_NEAR(bound_m(-500, 500), 1.0, kRounding);
  EXPECT_NEAR(bound_m(5'000, 6'000), 0.0, kRounding);
}

}  // namespace
}  // namespace glidar
