// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Radial velocities of echoes of several surfaces, mirrors and the air.
#include <glidar/simulate/echo_velocity.hpp>

#include <simulate/velocity_stage.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

using Eigen::Vector3d;
using testing::single_beam;
using testing::VelocityStage;

/// A beam whose halves hit a panel that comes nearer and a wall at rest 5 cm behind it.
VelocityStage two_surfaces(double gap_m) {
  VelocityStage stage = single_beam();
  stage.spread(4e-3);
  stage.add_wall(10.0, -50.0, 0.004);
  stage.add_wall(10.0 + gap_m);
  stage.motion = static_motion(stage.scene, Pose::Identity());
  stage.motion.world_from_instance[0] = ConstantTwist{.linear_m_s = {0.0, 0.0, -6.0}};
  return stage;
}

TEST(EchoVelocity, OfAnEchoOfTwoSurfacesIsTheirMeanWithTheWeightsOfItsRange) {
  const Frame frame = two_surfaces(0.05).shoot();
  ASSERT_EQ(frame.status[0], Status::hit);
  EXPECT_EQ(frame.return_source[0], ReturnSource::mixed_pixel);
  const double share = (frame.range_m[0] - 10.0) / 0.05;
  EXPECT_GT(share, 0.05);
  EXPECT_LT(share, 0.95);
  // sub-rays are up to 2 mrad off the axis: 2e-5 m of 0.05 m, and 2e-6 of 6 m/s
  EXPECT_NEAR(frame.radial_velocity_m_s[0], -6.0 * (1.0 - share), 6.0 * 1e-3);
  EXPECT_TRUE(std::abs(frame.true_radial_velocity_m_s[0] + 6.0) < 1e-4 ||
              frame.true_radial_velocity_m_s[0] == 0.0)
      << "the ground truth is that of one surface";
}

TEST(EchoVelocity, OfEachReturnIsThatOfItsOwnEcho) {
  VelocityStage stage = two_surfaces(5.0);
  stage.sensor.receiver.returns = {{Return::Order::nearest, 0}, {Return::Order::farthest, 0}};
  const Frame frame = stage.shoot();
  EXPECT_NEAR(frame.radial_velocity_m_s[0], -6.0, 1e-4);  // cosines of up to 2 mrad
  EXPECT_EQ(frame.radial_velocity_m_s[1], 0.0);
  EXPECT_EQ(frame.true_radial_velocity_m_s[1], 0.0);
}

/// By the image of the sensor behind the moving mirror, whose distance is the length of the path.
TEST(EchoVelocity, OfAGhostIsTheRateOfTheWholePathOverTheMovingMirror) {
  VelocityStage stage = single_beam();
  stage.sensor.lidar_equation =
      LidarEquation{.reference_reflectance = 0.01, .reference_range_m = 1e3};
  Material& mirror = stage.add_panel({-2.0, -2.0, 8.0}, {4.0, 0.0, 4.0}, {0.0, 4.0, 0.0});
  mirror.mirror = 0.8F;
  mirror.diffuse.setConstant(0.0F);
  stage.add_panel({5.0, -20.0, -10.0}, {0.0, 0.0, 40.0}, {0.0, 40.0, 0.0});
  stage.motion = static_motion(stage.scene, Pose::Identity());
  stage.motion.world_from_sensor =
      ConstantTwist{.angular_rad_s = {0.1, 0.3, 0.0}, .linear_m_s = {1.0, 0.5, 3.0}};
  stage.motion.world_from_instance[0] =
      ConstantTwist{.angular_rad_s = {0.02, 0.05, -0.04}, .linear_m_s = {-0.5, 0.2, 2.0}};
  stage.motion.world_from_instance[1] = ConstantTwist{.linear_m_s = {4.0, 1.0, 0.0}};
  const Frame frame = stage.shoot();
  ASSERT_EQ(frame.status[0], Status::hit);
  ASSERT_EQ(frame.return_source[0], ReturnSource::ghost);
  const Vector3d on_mirror(0.0, 0.0, 10.0);
  const Vector3d normal = Vector3d(1.0, 0.0, -1.0).normalized();
  const auto length_m = [&](std::int64_t t_ns) {
    const Pose mirror_at = pose_at(stage.motion.world_from_instance[0], t_ns);
    const Vector3d n = mirror_at.linear() * normal;
    const Vector3d sensor = pose_at(stage.motion.world_from_sensor, t_ns).translation();
    const Vector3d image = sensor - 2.0 * n.dot(sensor - mirror_at * on_mirror) * n;
    return (pose_at(stage.motion.world_from_instance[1], t_ns) * Vector3d(5.0, 0.0, 10.0) - image)
        .norm();
  };
  const double expected_m_s = (length_m(1'000'000) - length_m(-1'000'000)) / 2e-3;
  // the reflected beam begins 1e-6 m before the mirror; h^2 / 6 times third derivatives of 1 m/s^3
  EXPECT_NEAR(frame.radial_velocity_m_s[0], expected_m_s, 2e-6);
  EXPECT_GT(std::abs(expected_m_s), 1.0);
  EXPECT_NEAR(frame.true_radial_velocity_m_s[0], 2.0 - 3.0, 1e-13)
      << "the ground truth is that of the mirror, which moves along z with 2 m/s at (0, 0, 10)";
}

TEST(EchoVelocity, OfFogIsThatOfTheAirAtRest) {
  VelocityStage stage = single_beam();
  stage.sensor.wavelength_m = 905e-9;
  stage.sensor.lidar_equation =
      LidarEquation{.reference_reflectance = 0.1, .reference_range_m = 200.0};
  stage.sensor.weather = Weather{.visibility_m = 20.0, .fog_looks = 0};
  stage.sensor.receiver.returns = {{Return::Order::nearest, 0}};
  stage.add_wall(300.0);
  stage.motion = static_motion(stage.scene, Pose::Identity());
  stage.motion.world_from_sensor = ConstantTwist{.linear_m_s = {3.0, 0.0, 12.0}};
  stage.motion.world_from_instance[0] = ConstantTwist{.linear_m_s = {0.0, 0.0, 50.0}};
  const Frame frame = stage.shoot();
  ASSERT_EQ(frame.status[0], Status::hit);
  ASSERT_EQ(frame.return_source[0], ReturnSource::fog);
  EXPECT_EQ(frame.radial_velocity_m_s[0], -12.0);
  EXPECT_EQ(frame.true_radial_velocity_m_s[0], 38.0) << "the ground truth is that of the wall";
}

}  // namespace
}  // namespace glidar
