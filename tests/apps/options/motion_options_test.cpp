// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/motion_options.hpp>

#include <apps/glidar/options/information_options.hpp>
#include <apps/glidar/options/pose_options.hpp>
#include <glidar/core/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
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

TEST(MotionOptions, ModelRateTurnsTheModelAboutItsOwnAxes) {
  Scene scene = one_object();
  const Eigen::Quaterniond q = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized();
  scene.instances[0].world_from_object = legacy_world_from_object(q);
  const auto moving = instance_trajectories({.model_dr = "0.1,-0.2,0.3"}, scene, {});
  ASSERT_EQ(moving.size(), 1U);
  // R(q) takes inertial vectors into the body; its rate of change for a body rate w is -w x R(q)
  const double h = 1e-3;
  const Eigen::Matrix3d body_from_inertial = q.toRotationMatrix();
  const Eigen::Matrix3d later =
      pose_at(moving[0], static_cast<std::int64_t>(h * 1e9)).linear().transpose();
  Eigen::Matrix3d expected;
  const Eigen::Vector3d w(0.1, -0.2, 0.3);
  for (int i = 0; i < 3; ++i)
    expected.col(i) = -w.cross(Eigen::Vector3d(body_from_inertial.col(i)));
  // the first order of h: its error is h w^2 / 2
  EXPECT_LT(((later - body_from_inertial) / h - expected).norm(), h);
}

TEST(MotionOptions, CameraRateTurnsTheSensorAboutLeftUpForward) {
  const Pose start = legacy_world_from_optical(Eigen::Quaterniond::Identity(), 5.0);
  const MotionFlags flags{.camera_dr = std::to_string(std::numbers::pi / 2.0) + ",0,0"};
  const Trajectory turning = sensor_trajectory(flags, start, Pose::Identity(), true, {});
  const Pose after = pose_at(turning, kSecond_ns);
  EXPECT_LT((after.translation() - start.translation()).norm(), kExact);
  // a quarter turn about x (left), right-handed: forward goes to where down was
  const Eigen::Vector3d forward = after.linear() * Eigen::Vector3d::UnitZ();
  EXPECT_LT((forward + Eigen::Vector3d::UnitY()).norm(), 1e-5);  // to_string keeps 6 digits
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

std::string error_of(const MotionFlags& flags, bool pose_given = false,
                     const std::optional<Trajectory>& from_file = {}) {
  try {
    (void)sensor_trajectory(flags, Pose::Identity(), Pose::Identity(), pose_given, from_file);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(MotionOptions, SayWhatIsWrong) {
  using ::testing::HasSubstr;
  EXPECT_THAT(error_of({.camera_dr = "1,2"}), HasSubstr("--sensor-rate: '1,2' (2 numbers)"));
  EXPECT_THAT(error_of({.camera_dr = "1,2,nan"}), HasSubstr("'nan'"));
  EXPECT_THAT(error_of({.camera_dr = "1,2,1e10"}), HasSubstr("rad/s from -1e9 to 1e9"));
  EXPECT_THAT(error_of({.camera_dr = "1,2,3"}, false, Spin{}),
              HasSubstr("already moves the sensor"));
  EXPECT_THAT(error_of({.trajectory = "no-such-file"}), HasSubstr("no such file"));
  EXPECT_THAT(error_of({.trajectory = "t.tum"}, true), HasSubstr("where the sensor is"));
  EXPECT_THAT(error_of({.camera_dr = "1,2,3", .trajectory = "t.tum"}), HasSubstr("how it turns"));
  EXPECT_THAT(error_of({.trajectory_rate_hz = 10.0}), HasSubstr("there is no --trajectory"));
  EXPECT_THAT(error_of({.trajectory = "t", .trajectory_start_s = 1e10}), HasSubstr("up to 9.2e9"));
  EXPECT_THROW(instance_trajectories({.model_dr = "1,2,3"}, Scene{}, {}), Error);
  EXPECT_THROW(instance_trajectories({.model_dr = "1,2,3"}, one_object(), {Spin{}}), Error);
}

TEST(MotionOptions, FilesAreKnownSoThatNoOutputReplacesThem) {
  EXPECT_EQ(files_of({.trajectory = "a", .trajectory_times = "b"}),
            (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(files_of({}).empty());
}

TEST(FisherOptions, FileStandsBesideTheOutput) {
  EXPECT_EQ(information_path("x/cloud.v2.pcd"), "x/cloud.v2.information.json");
  EXPECT_EQ(information_path("view.depth.png"), "view.information.json");
}

TEST(FisherOptions, EveryFrameHasAFileAlsoWhereFramesShareAFolder) {
  EXPECT_EQ(information_path("x/out.kitti"), "x/out.information.json");
  EXPECT_EQ(information_path("x/out.kitti", 3), "x/out_000003.information.json");
  EXPECT_EQ(information_path("x/cloud_000003.pcd", 3), "x/cloud_000003.information.json");
}

TEST(FisherOptions, SigmaMustBeAboveZeroAndWanted) {
  OutputFlags file;
  file.paths = {"a.pcd"};
  EXPECT_NO_THROW(check(InformationFlags{.wanted = true, .sigma_m = 0.1}, file));
  EXPECT_NO_THROW(check(InformationFlags{}, file));
  EXPECT_THROW(check(InformationFlags{.wanted = true, .sigma_m = 0.0}, file), Error);
  EXPECT_THROW(check(InformationFlags{.wanted = false, .sigma_m = 0.1}, file), Error);
}

TEST(FisherOptions, NeedAFileBesideWhichTheirsIsWritten) {
  const InformationFlags wanted{.wanted = true};
  OutputFlags outputs;
  outputs.format = "pcd";
  outputs.paths = {"-"};
  EXPECT_THROW(check(wanted, outputs), Error);
  outputs.paths = {"-", "a.pcd"};
  EXPECT_NO_THROW(check(wanted, outputs));
}

}  // namespace
}  // namespace glidar::app
