// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/motion/motion.hpp>
#include <glidar/motion/pose_block.hpp>

#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

using ::testing::HasSubstr;

constexpr double kExact = 1e-14;

Eigen::Quaterniond about_z(double angle_rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()));
}

TimedPoses two() {
  return TimedPoses({{.t_ns = 1000, .position_m = {0.0, 0.0, 0.0}, .orientation = about_z(0.2)},
                     {.t_ns = 2000, .position_m = {2.0, 4.0, -6.0}, .orientation = about_z(1.2)}});
}

TEST(TimedPoses, InterpolateLinearlyAndBySlerp) {
  const Pose quarter = two().pose_at(1250);
  EXPECT_LT((quarter.translation() - Eigen::Vector3d(0.5, 1.0, -1.5)).norm(), kExact);
  EXPECT_LT((quarter.linear() - about_z(0.45).toRotationMatrix()).norm(), kExact);
}

TEST(TimedPoses, AreConstantOutsideTheInterval) {
  EXPECT_EQ(two().pose_at(-5).matrix(), two().pose_at(1000).matrix());
  EXPECT_EQ(two().pose_at(999'999).matrix(), two().pose_at(2000).matrix());
}

TEST(TimedPoses, RotateTheShortWayForEitherSign) {
  Eigen::Quaterniond minus = about_z(1.0);
  minus.coeffs() = -minus.coeffs();
  const TimedPoses poses(
      {{.t_ns = 0, .orientation = about_z(0.0)}, {.t_ns = 10, .orientation = minus}});
  EXPECT_LT((poses.pose_at(5).linear() - about_z(0.5).toRotationMatrix()).norm(), kExact);
}

TEST(TimedPoses, KeepNanosecondsOfTimesSinceTheEpoch) {
  const std::int64_t t = 1'403'636'579'763'555'584;
  const TimedPoses poses({{.t_ns = t}, {.t_ns = t + 8, .position_m = {8.0, 0.0, 0.0}}});
  EXPECT_DOUBLE_EQ(poses.pose_at(t + 3).translation().x(), 3.0);
}

std::string error_of(std::vector<TimedPose> poses) {
  return error_text([&] { const TimedPoses made(std::move(poses)); });
}

TEST(TimedPoses, ReportTheInvalidEntry) {
  EXPECT_THAT(error_of({}), HasSubstr("there is none"));
  EXPECT_THAT(error_of({{.t_ns = 5}, {.t_ns = 5}}),
              HasSubstr("entry 2: the same time as the previous pose"));
  EXPECT_THAT(error_of({{.t_ns = 5}, {.t_ns = 4}}), HasSubstr("entry 2: a time before"));
  EXPECT_THAT(error_of({{.t_ns = 5, .position_m = {0.0, std::nan(""), 0.0}}}),
              HasSubstr("entry 1"));
  EXPECT_THAT(error_of({{.t_ns = 5, .orientation = Eigen::Quaterniond(0.5, 0.0, 0.0, 0.0)}}),
              HasSubstr("a quaternion of length 0.5"));
  EXPECT_THAT(
      error_of({{.t_ns = 5, .orientation = Eigen::Quaterniond(std::nan(""), 0.0, 0.0, 0.0)}}),
      HasSubstr("length 1"));
}

/// Dividing a quaternion by its length again may change its last bit, so a copy must not.
TEST(TimedPoses, RestoredPosesAreBitIdentical) {
  std::vector<TimedPose> poses;
  for (int k = 0; k < 1000; ++k) {
    const Eigen::Quaterniond q(0.1 + k, 0.7 - 3.0 * k, 0.3 * k, 1.1);
    poses.push_back({.t_ns = k, .orientation = q.normalized()});
  }
  const TimedPoses first(std::move(poses));
  const TimedPoses again = TimedPoses::restored({first.poses().begin(), first.poses().end()});
  for (std::size_t k = 0; k < first.poses().size(); ++k) {
    EXPECT_EQ(first.poses()[k].orientation.coeffs(), again.poses()[k].orientation.coeffs());
  }
}

TEST(TimedPoses, RestoredPosesAreChecked) {
  EXPECT_THROW(TimedPoses::restored({}), Error);
  EXPECT_THROW(TimedPoses::restored({{.t_ns = 1}, {.t_ns = 1}}), Error);
  const Eigen::Quaterniond nearly(1.0001, 0.0, 0.0, 0.0);  // files may hold it, restored poses not
  EXPECT_NO_THROW(TimedPoses({{.t_ns = 1, .orientation = nearly}}));
  EXPECT_THROW(TimedPoses::restored({{.t_ns = 1, .orientation = nearly}}), Error);
}

/// Expects that blocks of poses have the bits of pose_at().
void expect_same_in_blocks(const Trajectory& trajectory, const std::vector<std::int64_t>& times) {
  PoseBlock block;
  for (std::size_t first = 0; first < times.size(); first += PoseBlock::kSize) {
    const std::size_t count = std::min(PoseBlock::kSize, times.size() - first);
    poses_at(trajectory, {times.data() + first, count}, block);
    for (std::size_t i = 0; i < count; ++i) {
      const Pose pose = pose_at(trajectory, times[first + i]);
      ASSERT_EQ(block.rotation_at(i), Eigen::Matrix3d(pose.linear())) << times[first + i];
      ASSERT_EQ(block.position_at(i), Eigen::Vector3d(pose.translation())) << times[first + i];
    }
  }
}

TEST(Trajectory, ManyTimesAreIdenticalToSingleOnes) {
  std::vector<TimedPose> poses;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d(1.0, std::sin(i), 2.0).normalized();
    poses.push_back({.t_ns = 1000 * i + 13 * (i % 7),
                     .position_m = {std::sin(0.1 * i), 0.2 * i, 1e-3 * i * i},
                     .orientation = i % 50 < 40
                                        ? Eigen::Quaterniond(Eigen::AngleAxisd(0.3 * i, axis))
                                        : about_z(2.0)});
  }
  for (const std::size_t i : {7U, 45U, 60U}) poses[i].orientation.coeffs() *= -1.0;
  const std::vector<Trajectory> kinds = {
      ConstantPose{},
      ConstantTwist{.angular_rad_s = {0.1, 0.2, 0.3}},
      Spin{.rate_rad_s = {0.1, 0.2, 0.3}},
      TimedPoses(poses),
      Mounted{TimedPoses(poses), look_at({1, 2, 3}, {0, 0, 0})},
      TorqueFreeRotation({.moments_kg_m2 = {1.0, 2.0, 2.5}, .rate_rad_s = {0.1, 0.2, 0.3}})};
  std::vector<std::int64_t> times;  // rising in small and large steps, falling, outside, on a pose
  for (int i = -100; i < 10'000; ++i) times.push_back(21 * i);
  for (int i = 0; i < 500; ++i) times.push_back((i * 7919) % 200'000);
  for (int i = 0; i < 100; ++i) times.push_back(20'000LL * i);
  for (const TimedPose& pose : poses) times.push_back(pose.t_ns);
  for (const Trajectory& trajectory : kinds) {
    std::vector<Pose> out(times.size());
    poses_at(trajectory, times, out);
    for (std::size_t i = 0; i < times.size(); ++i) {
      ASSERT_EQ(out[i].matrix(), pose_at(trajectory, times[i]).matrix()) << times[i];
    }
    expect_same_in_blocks(trajectory, times);
  }
  std::vector<Pose> short_by_one(times.size() - 1);
  EXPECT_THROW(poses_at(kinds[0], times, short_by_one), Error);
  PoseBlock block;
  EXPECT_THROW(poses_at(kinds[0], times, block), Error);
}

TEST(Trajectory, ExtrapolationIsReported) {
  std::string said;
  const Report report{.log = [&](Severity, std::string_view text) { said = text; }, .progress = {}};
  warn_extrapolation(two(), "rock", {.first_ns = 1000, .last_ns = 2000}, report);
  warn_extrapolation(Spin{}, "rock", {.first_ns = -1000, .last_ns = 2000}, report);
  EXPECT_EQ(said, "");
  warn_extrapolation(two(), "rock", {.first_ns = 1000, .last_ns = 2001}, report);
  EXPECT_THAT(said, HasSubstr("rock: the trajectory is defined from 0.000001 s to 0.000002 s"));
  EXPECT_THAT(said, HasSubstr("its first or last pose is used"));
}

TEST(Trajectory, NumbersThatAreNotFiniteAreErrors) {
  const Eigen::Vector3d bad(0.0, std::nan(""), 0.0);
  EXPECT_THROW(validate(Spin{.rate_rad_s = bad}), Error);
  EXPECT_THROW(validate(ConstantTwist{.angular_rad_s = bad}), Error);
  EXPECT_THROW(validate(ConstantTwist{.linear_m_s = bad}), Error);
  Pose scaled = Pose::Identity();
  scaled.linear() *= 2.0;
  EXPECT_THROW(validate(ConstantPose{scaled}), Error);
  EXPECT_NO_THROW(validate(Spin{}));
}

TEST(MakeMotion, RequiresOneTrajectoryPerInstanceOrNone) {
  Scene scene;
  scene.instances.push_back({.name = "a", .materials = {}});
  scene.instances[0].world_from_object.translation().x() = 4.0;
  const Motion still = make_motion(scene, ConstantPose{}, {});
  EXPECT_EQ(pose_at(still.world_from_instance.at(0), 7).translation().x(), 4.0);
  const Motion turning =
      make_motion(scene, ConstantPose{}, {ConstantTwist{.linear_m_s = {1.0, 0.0, 0.0}}});
  Frame frame;
  frame.stamp_ns = 2'000'000'000;
  sample_poses(turning, frame);
  EXPECT_DOUBLE_EQ(frame.world_from_instance.at(0).translation().x(), 2.0);
  EXPECT_THROW(make_motion(scene, ConstantPose{}, {Spin{}, Spin{}}), Error);
}

}  // namespace
}  // namespace glidar
