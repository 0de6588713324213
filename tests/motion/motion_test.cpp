// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/motion/motion.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace glidar {
namespace {

constexpr double kExact = 1e-13;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

Pose somewhere() {
  return make_pose({1.0, -2.0, 3.0}, Eigen::Quaterniond(0.5, 0.1, -0.7, 0.3));
}

/// The exponential as its power series, after halving the twist often.
Eigen::Matrix4d series(const Eigen::Vector3d& rotation, const Eigen::Vector3d& translation) {
  constexpr int kHalvings = 12;
  Eigen::Matrix4d twist = Eigen::Matrix4d::Zero();
  twist.topLeftCorner<3, 3>() << 0.0, -rotation.z(), rotation.y(), rotation.z(), 0.0, -rotation.x(),
      -rotation.y(), rotation.x(), 0.0;
  twist.topRightCorner<3, 1>() = translation;
  twist /= std::ldexp(1.0, kHalvings);
  Eigen::Matrix4d sum = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d term = Eigen::Matrix4d::Identity();
  for (int k = 1; k < 12; ++k) {
    term = (term * twist / k).eval();
    sum += term;
  }
  for (int i = 0; i < kHalvings; ++i) sum = (sum * sum).eval();
  return sum;
}

TEST(Se3Exp, IsItsPowerSeries) {
  const Eigen::Vector3d translation(0.3, -1.2, 2.0);
  for (const double angle : {0.0, 1e-9, 1e-4, 0.0999, 0.1001, 1.0, 3.0, 6.0}) {
    const Eigen::Vector3d rotation = angle * Eigen::Vector3d(2.0, -1.0, 2.0) / 3.0;
    const Eigen::Matrix4d found = se3_exp(rotation, translation).matrix();
    // squaring twelve times multiplies roundings by 4096
    EXPECT_LT((found - series(rotation, translation)).norm(), 4e-12) << angle;
  }
}

TEST(ConstantTwist, CircleClosesAfterAFullTurn) {
  const ConstantTwist circle{.pose = somewhere(),
                             .angular_rad_s = {0.0, 0.0, 2.0 * std::numbers::pi},
                             .linear_m_s = {3.0, 0.0, 0.0}};
  EXPECT_LT((pose_at(circle, 5 * kSecond_ns).matrix() - somewhere().matrix()).norm(), kExact * 10);
  // half a turn later it is across the circle, whose radius is v / w, to the left of the velocity
  const Eigen::Vector3d across(0.0, 2.0 * 3.0 / (2.0 * std::numbers::pi), 0.0);
  const Pose half = pose_at(circle, kSecond_ns / 2);
  EXPECT_LT((half.translation() - somewhere() * across).norm(), kExact);
}

TEST(ConstantTwist, BodyTwistIsTheVelocityInTheBody) {
  const ConstantTwist twist{
      .pose = somewhere(), .angular_rad_s = {0.1, 0.2, -0.3}, .linear_m_s = {1.0, 2.0, 3.0}};
  const std::int64_t h_ns = 1000;
  const double h = 1e-6;
  const Pose now = pose_at(twist, kSecond_ns);
  const Eigen::Vector3d moved = pose_at(twist, kSecond_ns + h_ns).translation() -
                                pose_at(twist, kSecond_ns - h_ns).translation();
  // central difference: rounding 1e-16 * 5 m / 1e-6
  EXPECT_LT((now.linear().transpose() * moved / (2.0 * h) - twist.linear_m_s).norm(), 1e-8);
}

TEST(ConstantTwist, WorldTwistRotatesAboutTheWorldsOrigin) {
  const ConstantTwist twist{.pose = somewhere(),
                            .angular_rad_s = {0.0, 0.0, std::numbers::pi / 2.0},
                            .frame = TwistFrame::world};
  const Pose turned = pose_at(twist, kSecond_ns);
  EXPECT_LT((turned.translation() - Eigen::Vector3d(2.0, 1.0, 3.0)).norm(), kExact);
}

TEST(ConstantTwist, BodyAndWorldTwistsAreRelatedByTheAdjoint) {
  const Eigen::Vector3d w(0.4, -0.3, 0.9);
  const Eigen::Vector3d v(1.0, 0.5, -2.0);
  const Pose pose = somewhere();
  const Eigen::Vector3d w_world = pose.linear() * w;
  const ConstantTwist body{.pose = pose, .angular_rad_s = w, .linear_m_s = v};
  const ConstantTwist world{.pose = pose,
                            .angular_rad_s = w_world,
                            .linear_m_s = pose.linear() * v + pose.translation().cross(w_world),
                            .frame = TwistFrame::world};
  for (int t = -3; t < 4; ++t) {
    EXPECT_LT(
        (pose_at(body, t * kSecond_ns).matrix() - pose_at(world, t * kSecond_ns).matrix()).norm(),
        1e-12);
  }
}

TEST(ConstantTwist, FarTimesKeepTheirNanoseconds) {
  const std::int64_t epoch_ns = 1'700'000'000'123'456'789;
  const ConstantTwist twist{.linear_m_s = {1.0, 0.0, 0.0}, .t0_ns = epoch_ns};
  EXPECT_DOUBLE_EQ(pose_at(twist, epoch_ns + 1).translation().x(), 1e-9);
  EXPECT_DOUBLE_EQ(pose_at(twist, epoch_ns - 1).translation().x(), -1e-9);
  // no overflow between the extreme times
  const ConstantTwist early{.linear_m_s = {1.0, 0.0, 0.0},
                            .t0_ns = std::numeric_limits<std::int64_t>::min()};
  EXPECT_DOUBLE_EQ(pose_at(early, std::numeric_limits<std::int64_t>::max()).translation().x(),
                   18446744073.709551615);
}

TEST(Spin, RotatesInPlaceAboutItsOwnAxes) {
  const Spin spin{.pose = somewhere(), .rate_rad_s = {0.0, std::numbers::pi / 4.0, 0.0}};
  const Pose pose = pose_at(spin, 2 * kSecond_ns);
  EXPECT_EQ(pose.translation(), somewhere().translation());
  const Eigen::Vector3d x_now =
      somewhere().linear().transpose() * pose.linear() * Eigen::Vector3d::UnitX();
  EXPECT_LT((x_now + Eigen::Vector3d::UnitZ()).norm(), kExact);
}

}  // namespace

namespace {

TEST(StaticMotion, PosesAreThoseOfTheScene) {
  Scene scene;
  scene.instances.push_back({.name = "a", .materials = {}});
  scene.instances[0].world_from_object.translation() = Eigen::Vector3d(1.0, 2.0, 3.0);
  Pose sensor = Pose::Identity();
  sensor.translation() = Eigen::Vector3d(0.0, 0.0, 9.0);
  Frame frame;
  frame.stamp_ns = 123;
  sample_poses(static_motion(scene, sensor), frame);
  EXPECT_TRUE(frame.world_from_sensor.isApprox(sensor));
  ASSERT_EQ(frame.world_from_instance.size(), 1U);
  EXPECT_TRUE(frame.world_from_instance[0].isApprox(scene.instances[0].world_from_object));
}

/// A transform with a general rotation axis.
Pose some_move() {
  return make_pose({0.5, -2.0, 1.0}, Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2));
}

/// One trajectory of every kind, in the order of the variant.
std::vector<Trajectory> all_kinds() {
  const Pose start = make_pose({1.0, 2.0, 3.0}, Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5));
  const Eigen::Vector3d rate(0.3, -0.2, 0.7);
  const Eigen::Vector3d velocity(1.0, 0.5, -2.0);
  return {
      ConstantPose{start},
      ConstantTwist{start, rate, velocity, TwistFrame::body, 0},
      ConstantTwist{start, rate, velocity, TwistFrame::world, 0},
      Spin{.pose = start, .rate_rad_s = rate},
      TimedPoses({{0, {0.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()},
                  {1'000'000'000, {1.0, 0.0, 2.0}, Eigen::Quaterniond(0.6, 0.8, 0.0, 0.0)}}),
      TorqueFreeRotation({.moments_kg_m2 = {1.0, 2.0, 2.5},
                          .rate_rad_s = rate,
                          .world_from_body = start,
                          .velocity_m_s = velocity}),
      Mounted{TorqueFreeRotation({.moments_kg_m2 = {1.0, 2.0, 2.5}, .rate_rad_s = rate}), start}};
}

constexpr double kRoundingOfMounts = 1e-12;

TEST(Mounted, IsThePartOnTheBodyAtAnyTimeForEveryKind) {
  const Pose part = some_move();
  for (const Trajectory& body : all_kinds()) {
    const Trajectory sensor = compose_extrinsic(body, part);
    for (const std::int64_t t_ns : {-2'000'000'000LL, 0LL, 400'000'000LL, 7'300'000'000LL}) {
      const Pose expected = pose_at(body, t_ns) * part;
      EXPECT_TRUE(pose_at(sensor, t_ns).isApprox(expected, kRoundingOfMounts)) << body.index();
    }
  }
}

TEST(Mounted, AtTheBodysOriginIsBitIdenticalToTheBody) {
  for (const Trajectory& body : all_kinds()) {
    const Trajectory same = compose_extrinsic(body, Pose::Identity());
    EXPECT_EQ(same.index(), body.index());
    EXPECT_EQ(pose_at(same, 700'000'000).matrix(), pose_at(body, 700'000'000).matrix());
  }
}

TEST(Mounted, ManyPosesAreIdenticalToSingleOnesAndTheIntervalIsTheCarriers) {
  const Trajectory carrier =
      TimedPoses({{0, {0.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()},
                  {1'000'000'000, {1.0, 0.0, 2.0}, Eigen::Quaterniond(0.6, 0.8, 0.0, 0.0)}});
  const Trajectory sensor = compose_extrinsic(carrier, some_move());
  EXPECT_EQ(valid_interval(sensor).last_ns, 1'000'000'000);
  const std::vector<std::int64_t> times = {-1, 0, 250'000'000, 999'999'999, 2'000'000'000};
  std::vector<Pose> poses(times.size());
  poses_at(sensor, times, poses);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_EQ(poses[i].matrix(), pose_at(sensor, times[i]).matrix());
  }
}

TEST(Mounted, RejectsAPoseThatIsNotRigid) {
  Pose scaled = Pose::Identity();
  scaled.linear() *= 2.0;
  EXPECT_THROW(validate(Mounted{TorqueFreeRotation(InitialRotation{}), scaled}), Error);
}

TEST(Transformed, IsTheTransformTimesThePoseForEveryKind) {
  constexpr double kRounding = 1e-12;
  const Pose move = some_move();
  const std::vector<Trajectory> kinds = all_kinds();
  ASSERT_EQ(kinds.back().index() + 1, std::variant_size_v<Trajectory>);
  for (const Trajectory& trajectory : kinds) {
    const Trajectory result = transformed(move, trajectory);
    EXPECT_EQ(result.index(), trajectory.index());
    for (const std::int64_t t_ns : {-500'000'000LL, 0LL, 400'000'000LL, 3'000'000'000LL}) {
      EXPECT_TRUE(pose_at(result, t_ns).isApprox(move * pose_at(trajectory, t_ns), kRounding))
          << "kind " << trajectory.index() << " at " << t_ns;
    }
  }
}

}  // namespace
}  // namespace glidar
