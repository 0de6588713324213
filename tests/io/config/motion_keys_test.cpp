// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/motion_keys.hpp>

#include <glidar/io/config/scene_file.hpp>

#include "io/yaml_files.hpp"

#include <gmock/gmock.h>

#include <numbers>

namespace glidar {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// The one model of a scene file, with this motion and pose.
Trajectory motion(const std::string& content) {
  const TestFolder folder;
  (void)folder.write("orbit.tum", "10 1 2 3 0 0 0 1\n12 5 2 3 0 0 0 1\n");
  (void)folder.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 8 0 1 0 0 0 0 1 0\n");
  const auto file = folder.write("s.yaml", "models: [{model: builtin:box, " + content + "}]\n");
  return load_scene_file(file, {}, {}).world_from_instance.at(0);
}

TEST(MotionKeys, SpinStartsAtThePose) {
  const auto spin = std::get<Spin>(
      motion("pose: {position: [1, 2, 3]}, motion: {spin: {rate_deg_s: [0, 0, 90]}}"));
  EXPECT_EQ(spin.pose.translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_DOUBLE_EQ(spin.rate_rad_s.z(), std::numbers::pi / 2.0);
}

TEST(MotionKeys, TwistTakesEveryKey) {
  const auto twist = std::get<ConstantTwist>(
      motion("motion: {twist: {rate_rad_s: [1, 2, 3], velocity_m_s: [4, 5, 6], frame: world}}"));
  EXPECT_EQ(twist.angular_rad_s, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(twist.linear_m_s, Eigen::Vector3d(4.0, 5.0, 6.0));
  EXPECT_EQ(twist.frame, TwistFrame::world);
  const auto straight =
      std::get<ConstantTwist>(motion("motion: {twist: {velocity_m_s: [1, 0, 0]}}"));
  EXPECT_EQ(straight.angular_rad_s, Eigen::Vector3d::Zero());
  EXPECT_EQ(straight.frame, TwistFrame::body);
}

TEST(MotionKeys, TumblingTakesEveryKey) {
  const auto body = std::get<TorqueFreeRotation>(
      motion("motion: {tumbling: {moments_kg_m2: [1, 2, 2.5], rate_rad_s: [0.1, 0.2, 0.3], "
             "velocity_m_s: [1, 0, 0], principal: {position: [0.5, 0, 0]}}}"));
  EXPECT_EQ(body.start().moments_kg_m2, Eigen::Vector3d(1.0, 2.0, 2.5));
  EXPECT_EQ(body.start().rate_rad_s, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(body.start().velocity_m_s, Eigen::Vector3d(1.0, 0.0, 0.0));
  EXPECT_EQ(body.start().body_from_principal.translation(), Eigen::Vector3d(0.5, 0.0, 0.0));
}

TEST(MotionKeys, TrajectoryIsAPathOrAMap) {
  EXPECT_EQ(pose_at(motion("motion: {trajectory: orbit.tum}"), 11 * kSecond_ns).translation().x(),
            3.0);
  EXPECT_EQ(pose_at(motion("motion: {trajectory: {file: orbit.tum, start_s: 0}}"), kSecond_ns)
                .translation()
                .x(),
            3.0);
  EXPECT_EQ(pose_at(motion("motion: {trajectory: {file: poses.txt, rate_hz: 2}}"), kSecond_ns / 4)
                .translation()
                .x(),
            4.0);
}

TEST(MotionKeys, StartTimesAreExactToTheNanosecond) {
  // a double of these sizes has steps of 238 ns
  const std::pair<const char*, std::int64_t> kTimes[] = {
      {"1700000000.123456789", 1'700'000'000'123'456'789},
      {"1.700000000123456789e9", 1'700'000'000'123'456'789},
      {"-1700000000.000000001", -1'700'000'000'000'000'001},
      {"+9.2e9", 9'200'000'000'000'000'000},
      {"0.0000000015", 2}};
  for (const auto& [text, expected_ns] : kTimes) {
    const auto moved = std::get<TimedPoses>(
        motion("motion: {trajectory: {file: orbit.tum, start_s: " + std::string(text) + "}}"));
    EXPECT_EQ(moved.first_ns(), expected_ns) << text;
  }
}

TEST(MotionKeys, StartTimesThatAreNoSecondsAreRejected) {
  for (const char* text : {"now", "1e10", ".inf", "5 s"}) {
    try {
      (void)motion("motion: {trajectory: {file: orbit.tum, start_s: " + std::string(text) + "}}");
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("allowed: seconds from -9.2e9 to 9.2e9"));
      EXPECT_THAT(error.what(), ::testing::HasSubstr("motion.trajectory.start_s"));
    }
  }
}

TEST(MotionKeys, SceneShowsEverythingAtTimeZero) {
  const TestFolder folder;
  (void)folder.write("orbit.tum", "-1 1 2 3 0 0 0 1\n1 5 2 3 0 0 0 1\n");
  const auto file = folder.write("s.yaml",
                                 "models:\n"
                                 "  - {model: builtin:box, motion: {trajectory: orbit.tum}}\n"
                                 "  - {model: builtin:box, pose: {position: [0, 9, 0]}}\n"
                                 "sensor_pose: {position: [0, 0, -5]}\n"
                                 "sensor_motion: {twist: {velocity_m_s: [0, 0, 1]}}\n");
  const SceneFile scene = load_scene_file(file, {}, {});
  EXPECT_EQ(scene.scene.instances[0].world_from_object.translation().x(), 3.0);
  ASSERT_EQ(scene.world_from_instance.size(), 2U);
  EXPECT_EQ(pose_at(scene.world_from_instance[1], kSecond_ns).translation().y(), 9.0);
  ASSERT_TRUE(scene.world_from_rig && scene.rig_motion);
  EXPECT_EQ(pose_at(*scene.rig_motion, kSecond_ns).translation().z(), -4.0);
  ASSERT_EQ(scene.files.size(), 2U);  // neither may be overwritten
  EXPECT_EQ(std::filesystem::path(scene.files[1]).filename(), "orbit.tum");
}

TEST(MotionKeys, AStillSceneHasNoTrajectories) {
  const TestFolder folder;
  const auto file = folder.write("s.yaml", "models: [{model: builtin:box}]\n");
  EXPECT_TRUE(load_scene_file(file, {}, {}).world_from_instance.empty());
}

}  // namespace
}  // namespace glidar
