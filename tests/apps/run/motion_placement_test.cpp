// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/placement.hpp>
#include <glidar/core/error.hpp>

#include <gtest/gtest.h>

#include <numbers>

namespace glidar::app {
namespace {

constexpr double kExact = 1e-12;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

Scene one_object() {
  Scene scene;
  scene.instances.push_back({.name = "object", .materials = {}});
  return scene;
}

TEST(MotionOptions, ObjectRateRotatesTheModelAboutItsOwnAxes) {
  Scene scene = one_object();
  const Eigen::Quaterniond q = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized();
  scene.instances[0].world_from_object = woods2016_world_from_object(q);
  const auto moving =
      instance_trajectories({.object_rate_rad_s = Eigen::Vector3d(0.1, -0.2, 0.3)}, scene, {});
  ASSERT_EQ(moving.size(), 1U);
  // R(q) rotates inertial vectors into the body; its derivative for a body rate w is -w x R(q)
  const double h = 1e-3;
  const Eigen::Matrix3d body_from_inertial = q.toRotationMatrix();
  const Eigen::Matrix3d later =
      pose_at(moving[0], static_cast<std::int64_t>(h * 1e9)).linear().transpose();
  Eigen::Matrix3d expected;
  const Eigen::Vector3d w(0.1, -0.2, 0.3);
  for (int i = 0; i < 3; ++i)
    expected.col(i) = -w.cross(Eigen::Vector3d(body_from_inertial.col(i)));
  // first order in h: the error is h w^2 / 2
  EXPECT_LT(((later - body_from_inertial) / h - expected).norm(), h);
}

TEST(MotionOptions, SensorRateRotatesTheSensorAboutLeftUpForward) {
  const Pose start = woods2016_world_from_optical(Eigen::Quaterniond::Identity(), 5.0);
  const MotionFlags flags{.sensor_rate_rad_s = Eigen::Vector3d(std::numbers::pi / 2.0, 0.0, 0.0)};
  const Trajectory turning = sensor_trajectory(flags, start, Pose::Identity(), true, {});
  const Pose after = pose_at(turning, kSecond_ns);
  EXPECT_LT((after.translation() - start.translation()).norm(), kExact);
  // 90 degrees about x (left), right-handed: forward becomes down
  const Eigen::Vector3d forward = after.linear() * Eigen::Vector3d::UnitZ();
  EXPECT_LT((forward + Eigen::Vector3d::UnitY()).norm(), kExact);
}

TEST(MotionOptions, WithoutOptionsTheSceneFileDecides) {
  const Trajectory own = Spin{.rate_rad_s = {0.0, 0.0, 1.0}};
  EXPECT_TRUE(std::holds_alternative<Spin>(
      sensor_trajectory({}, Pose::Identity(), Pose::Identity(), false, own)));
  EXPECT_TRUE(std::holds_alternative<ConstantPose>(
      sensor_trajectory({}, Pose::Identity(), Pose::Identity(), true, own)));
  EXPECT_TRUE(std::holds_alternative<ConstantPose>(
      sensor_trajectory({}, Pose::Identity(), Pose::Identity(), false, {})));
  EXPECT_EQ(instance_trajectories({}, one_object(), {own}).size(), 1U);
  EXPECT_TRUE(instance_trajectories({}, one_object(), {}).empty());
}

TEST(MotionOptions, AreRefusedIfTheSceneFileHasMotion) {
  const MotionFlags flags{.object_rate_rad_s = Eigen::Vector3d(1.0, 2.0, 3.0),
                          .sensor_rate_rad_s = Eigen::Vector3d(1.0, 2.0, 3.0)};
  const Trajectory own = Spin{};
  EXPECT_THROW((void)sensor_trajectory(flags, Pose::Identity(), Pose::Identity(), false, own),
               Error);
  EXPECT_THROW((void)instance_trajectories(flags, Scene{}, {}), Error);
  EXPECT_THROW((void)instance_trajectories(flags, one_object(), {own}), Error);
}

TEST(MotionOptions, ATrajectoryFileThatDoesNotExistIsAnError) {
  EXPECT_THROW((void)sensor_trajectory({.trajectory = "no-such-file"}, Pose::Identity(),
                                       Pose::Identity(), false, {}),
               Error);
}

}  // namespace
}  // namespace glidar::app
