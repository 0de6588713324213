// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/radial_velocity.hpp>

#include <support/parameter_name.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace glidar {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kTime_ns = 730'000'000;
constexpr double kRounding_m_s = 1e-13;  // of speeds up to 100 m/s

Pose pose_of(const Vector3d& position_m, double angle_rad, const Vector3d& axis) {
  return make_pose(position_m, Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis.normalized())));
}

BeamPoint point_at(const Vector3d& direction, double range_m,
                   const Vector3d& origin_m = Vector3d::Zero()) {
  return {kTime_ns, origin_m, direction.normalized(), range_m};
}

/// Of a sensor and one object.
double velocity_m_s(Trajectory sensor, Trajectory object, const BeamPoint& point) {
  const Motion motion{std::move(sensor), {std::move(object)}};
  return RadialVelocities(motion).at(point, 0);
}

TEST(RadialVelocity, OfASensorThatDrivesTowardsAWallIsMinusItsSpeedTimesTheCosine) {
  const ConstantTwist sensor{.linear_m_s = {20.0, 0.0, 0.0}};
  for (const double angle : {0.0, 0.3, 1.0, std::numbers::pi / 2, 2.5}) {
    const BeamPoint point = point_at({std::cos(angle), std::sin(angle), 0.0}, 30.0);
    EXPECT_NEAR(velocity_m_s(sensor, ConstantPose{}, point), -20.0 * std::cos(angle), kRounding_m_s)
        << angle;
  }
}

TEST(RadialVelocity, OfAnObjectThatMovesAwayIsPositive) {
  const ConstantTwist object{.linear_m_s = {7.5, 0.0, 0.0}};
  EXPECT_EQ(velocity_m_s(ConstantPose{}, object, point_at({1.0, 0.0, 0.0}, 5.0)), 7.5);
}

TEST(RadialVelocity, IsExactlyZeroBetweenBodiesAtRest) {
  const ConstantPose sensor{pose_of({1e6, -2e5, 3.0}, 1.1, {1, 2, 3})};
  const ConstantPose object{pose_of({-3.0, 0.1, 9e5}, -2.0, {0, 1, -1})};
  for (const Vector3d& direction : {Vector3d(-1, -2, -3), Vector3d(1, 0, 0), Vector3d(-1, 0, 0)}) {
    const double velocity = velocity_m_s(sensor, object, point_at(direction, 123.4, {1, 2, 3}));
    EXPECT_EQ(velocity, 0.0);
    EXPECT_FALSE(std::signbit(velocity));
  }
}

/// A rotation in place moves the origin of a beam by w x r; beams from the axis see none of it.
TEST(RadialVelocity, OfARotatingSensorIsThatOfTheLeverArmOfTheBeamsOrigin) {
  const Spin sensor{.rate_rad_s = {0.0, 0.0, 3.0}};
  EXPECT_NEAR(velocity_m_s(sensor, ConstantPose{}, point_at({0.6, 0.8, 0.0}, 40.0)), 0.0,
              kRounding_m_s);
  // the origin at (0, 0.5, 0) moves with w x r = (-1.5, 0, 0): away from what is ahead
  EXPECT_NEAR(velocity_m_s(sensor, ConstantPose{}, point_at({1.0, 0.0, 0.0}, 40.0, {0, 0.5, 0})),
              1.5, kRounding_m_s);
}

TEST(RadialVelocity, OfASensorMountedBesideTheAxisOfItsCarrierIsThatOfTheMount) {
  const Trajectory carrier = ConstantTwist{.angular_rad_s = {0, 0, 2.0}, .linear_m_s = {10, 0, 0}};
  const Pose carrier_from_sensor = pose_of({0.0, 1.5, 0.7}, 0.0, {0, 0, 1});
  const Trajectory sensor = compose_extrinsic(carrier, carrier_from_sensor);
  // at time 0 the mount moves with (10 - 2 * 1.5, 0, 0)
  const Motion motion{sensor, {ConstantPose{}}};
  BeamPoint point = point_at({1, 0, 0}, 50.0);
  point.t_ns = 0;
  EXPECT_NEAR(RadialVelocities(motion).at(point, 0), -7.0, kRounding_m_s);
}

/// A wheel of radius r whose rim is seen along a tangent: the speed of the rim.
TEST(RadialVelocity, OfASpinningObjectIsTheSpeedOfItsSurfaceAlongTheBeam) {
  const double rate_rad_s = 5.0;
  const double radius_m = 0.8;
  const Pose wheel = pose_of({10.0, 0.0, 0.0}, 0.0, {0, 0, 1});
  const Spin object{.pose = wheel, .rate_rad_s = {0.0, 0.0, rate_rad_s}};
  const BeamPoint rim = point_at({1, 0, 0}, 10.0, {0.0, radius_m, 0.0});
  EXPECT_NEAR(velocity_m_s(ConstantPose{}, object, rim), -rate_rad_s * radius_m, kRounding_m_s);
  const BeamPoint hub = point_at({1, 0, 0}, 9.2);
  EXPECT_NEAR(velocity_m_s(ConstantPose{}, object, hub), 0.0, kRounding_m_s);
}

TEST(RadialVelocity, OfThePartsOfOneMovingBodyIsZero) {
  const Trajectory car = ConstantTwist{.pose = pose_of({1e5, 2e5, 0}, 0.4, {0, 0, 1}),
                                       .angular_rad_s = {0.1, 0.2, 1.5},
                                       .linear_m_s = {30.0, 0.0, 0.0}};
  const Trajectory sensor = compose_extrinsic(car, pose_of({1.2, 0.3, 1.8}, 0.2, {0, 1, 0}));
  EXPECT_NEAR(velocity_m_s(sensor, car, point_at({0.3, -0.4, -1.0}, 2.0, {0, 0.1, 0})), 0.0,
              1e-10);  // poses 2e5 m from the origin are exact to 3e-11 m, and turn with 1.5 rad/s
}

TEST(RadialVelocity, OfAirIsThatOfTheWorldAtRest) {
  const Motion motion{ConstantTwist{.linear_m_s = {0.0, 4.0, 0.0}}, {}};
  EXPECT_EQ(RadialVelocities(motion).at(point_at({0, 1, 0}, 0.0), kInvalidId), -4.0);
}

TEST(RadialVelocity, OfEachBeamIsThatOfItsOwnTimeAndInstance) {
  const Trajectory fast = ConstantTwist{.linear_m_s = {8.0, 0.0, 0.0}};
  std::vector<TimedPose> stops(3);
  for (std::int64_t k = 0; k < 3; ++k) stops[static_cast<std::size_t>(k)].t_ns = k * 1'000'000'000;
  stops[1].position_m.x() = 1.0;
  stops[2].position_m.x() = 4.0;
  const Motion motion{ConstantPose{}, {fast, TimedPoses(stops)}};
  RadialVelocities velocities(motion);
  BeamPoint point = point_at({1, 0, 0}, 5.0);
  for (int repeat = 0; repeat < 2; ++repeat) {
    point.t_ns = 500'000'000;
    EXPECT_NEAR(velocities.at(point, 0), 8.0, kRounding_m_s);
    EXPECT_NEAR(velocities.at(point, 1), 1.0, kRounding_m_s);
    point.t_ns = 1'500'000'000;
    EXPECT_NEAR(velocities.at(point, 1), 3.0, kRounding_m_s);
    EXPECT_NEAR(velocities.at(point, 0), 8.0, kRounding_m_s);
    point.t_ns = 5'000'000'000;  // after its last pose the object is at rest
    EXPECT_EQ(velocities.at(point, 1), 0.0);
  }
}

struct NamedTrajectory {
  std::string name;
  Trajectory trajectory;
};

void PrintTo(const NamedTrajectory& named, std::ostream* out) {
  *out << named.name;
}

std::vector<TimedPose> curve() {
  std::vector<TimedPose> poses;
  for (int k = 0; k < 6; ++k) {
    const double t = 0.4 * k;
    poses.push_back({.t_ns = k * 400'000'000,
                     .position_m = {3.0 * t, std::sin(2.0 * t), 0.2 * t * t},
                     .orientation = Eigen::Quaterniond(
                         Eigen::AngleAxisd(0.5 * t, Vector3d(1, 2, -1).normalized()))});
  }
  return poses;
}

std::vector<NamedTrajectory> trajectories() {
  const Pose at = pose_of({2.0, -1.0, 0.5}, 0.7, {1, 1, 0});
  const Trajectory spline = TimedPoses(curve(), Interpolation::spline);
  return {{"Constant", ConstantPose{at}},
          {"BodyTwist",
           ConstantTwist{.pose = at, .angular_rad_s = {0.4, -1, 2}, .linear_m_s = {3, 1, -2}}},
          {"WorldTwist", ConstantTwist{.pose = at,
                                       .angular_rad_s = {0.4, -1, 2},
                                       .linear_m_s = {3, 1, -2},
                                       .frame = TwistFrame::world}},
          {"Spin", Spin{.pose = at, .rate_rad_s = {1, 2, 3}}},
          {"Linear", TimedPoses(curve())},
          {"Spline", spline},
          {"Tumbling", TorqueFreeRotation({.moments_kg_m2 = {1.0, 2.0, 2.5},
                                           .rate_rad_s = {0.3, 2.0, 0.1},
                                           .world_from_body = at,
                                           .velocity_m_s = {1, -2, 0.5}})},
          {"Mounted", compose_extrinsic(spline, pose_of({0.5, 0.2, -1.0}, 1.0, {0, 1, 1}))}};
}

/// The distance between the beam's origin, fixed to the sensor, and the point, fixed to the object.
double distance_m(const Motion& motion, std::int64_t t_ns, const Vector3d& in_sensor,
                  const Vector3d& in_object) {
  return (pose_at(motion.world_from_instance[0], t_ns) * in_object -
          pose_at(motion.world_from_sensor, t_ns) * in_sensor)
      .norm();
}

/// Central differences, an independent derivative: the error of the step h is h^2 / 6 times the
/// third derivative, which Richardson's extrapolation from h and h / 2 removes.
double difference_m_s(const Motion& motion, const Vector3d& in_sensor, const Vector3d& in_object) {
  const auto slope = [&](std::int64_t h_ns) {
    const double after = distance_m(motion, kTime_ns + h_ns, in_sensor, in_object);
    const double before = distance_m(motion, kTime_ns - h_ns, in_sensor, in_object);
    return (after - before) / (2e-9 * static_cast<double>(h_ns));
  };
  constexpr std::int64_t kStep_ns = 2'000'000;
  return (4.0 * slope(kStep_ns / 2) - slope(kStep_ns)) / 3.0;
}

class RadialVelocityOf : public ::testing::TestWithParam<NamedTrajectory> {};

TEST_P(RadialVelocityOf, EveryTrajectoryIsTheDerivativeOfTheRangeOfTheSamePoint) {
  // Rounding of 1e-15 m over 2 ms, and h^4 / 480 times the fifth derivative, below 1e5 m/s^5 here.
  constexpr double kTolerance_m_s = 1e-8;
  const Vector3d origin_m(0.3, -0.2, 0.1);
  for (const NamedTrajectory& other : trajectories()) {
    for (const bool is_sensor : {true, false}) {
      const Motion motion{is_sensor ? GetParam().trajectory : other.trajectory,
                          {is_sensor ? other.trajectory : GetParam().trajectory}};
      const BeamPoint point = point_at({0.5, -0.3, 0.8}, 7.0, origin_m);
      const Vector3d hit_m = pose_at(motion.world_from_sensor, kTime_ns) *
                             (point.origin_m + point.range_m * point.direction);
      const Vector3d in_object = pose_at(motion.world_from_instance[0], kTime_ns).inverse() * hit_m;
      EXPECT_NEAR(RadialVelocities(motion).at(point, 0),
                  difference_m_s(motion, origin_m, in_object), kTolerance_m_s)
          << "with " << other.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Trajectories, RadialVelocityOf, ::testing::ValuesIn(trajectories()),
                         testing::parameter_name<NamedTrajectory>);

}  // namespace
}  // namespace glidar
