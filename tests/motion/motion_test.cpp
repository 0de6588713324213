// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/motion/motion.hpp>

#include <gtest/gtest.h>

namespace glidar {
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
