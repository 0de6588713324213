// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/scene_plan.hpp>

#include <glidar/io/config/motion_keys.hpp>
#include <glidar/io/config/scene_file.hpp>
#include <glidar/math/constants.hpp>

#include "io/yaml_files.hpp"

#include <gmock/gmock.h>

#include <numbers>

namespace glidar {
namespace {

ScenePlan planned(const TestFolder& folder, const std::string& content) {
  return read_scene_plan(folder.write("scene.yaml", content), {});
}

TEST(RigKeys, ARigHasItsSensorsWithNamesAndPosesInTheOrderOfTheList) {
  const TestFolder folder;
  const ScenePlan scene = read_scene_plan(
      folder.write(
          "scene.yaml",
          "models: [{model: a}]\n"
          "sensors:\n"
          "  - {name: lidar, sensor: VLP-16, pose: {position: [0, 0, 2]}}\n"
          "  - {name: cam-2, sensor: {optics: {type: pinhole, width: 8, height: 6, fov_deg: 20}}}\n"
          "rig_pose: {position: [1, 0, 0]}\n"
          "rig_motion: {twist: {velocity_m_s: [0, 3, 0]}}\n"),
      {});
  ASSERT_EQ(scene.sensors.size(), 2U);
  EXPECT_EQ(scene.sensors[0].name, "lidar");
  EXPECT_EQ(scene.sensors[0].rig_from_sensor.translation(), Eigen::Vector3d(0, 0, 2));
  EXPECT_EQ(scene.sensors[1].name, "cam-2");
  EXPECT_EQ(scene.sensors[1].rig_from_sensor.matrix(), Pose::Identity().matrix());
  EXPECT_TRUE(std::holds_alternative<Pinhole>(scene.sensors[1].sensor.optics));
  ASSERT_TRUE(scene.rig_motion && scene.world_from_rig);
  EXPECT_EQ(pose_at(*scene.rig_motion, 1'000'000'000).translation(), Eigen::Vector3d(1, 3, 0));
}

TEST(RigKeys, ASingleSensorIsARigWithoutAName) {
  const TestFolder folder;
  const ScenePlan scene = read_scene_plan(
      folder.write("scene.yaml",
                   "models: [{model: a}]\nsensor: VLP-16\nsensor_pose: {position: [1, 2, 3]}\n"),
      {});
  ASSERT_EQ(scene.sensors.size(), 1U);
  EXPECT_EQ(scene.sensors[0].name, "");
  EXPECT_EQ(scene.world_from_rig->translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(RigKeys, ASensorHasTheModeAndVariantThatTheSceneNames) {
  const TestFolder folder;
  (void)folder.write("c.yaml",
                     "optics: {width: 4, height: 2, fov_deg: 20}\nmodes: {fast: {rate_hz: 60}}\n"
                     "variants: {A: {}, B-1: {optics: {width: 9}}}\n");
  const std::string models = "models: [{model: a}]\n";
  const RigSensor own =
      planned(folder, models + "sensor: c.yaml#b1\nsensor_mode: fast\n").sensors.at(0);
  EXPECT_EQ(own.sensor.rate_hz, 60.0);
  EXPECT_EQ(own.sensor.mode, "fast");
  EXPECT_EQ(std::get<Pinhole>(own.sensor.optics).intrinsics.width, 9U);
  const ScenePlan rig = planned(folder, models +
                                            "sensors:\n- {name: a, sensor: OS1-32, mode: 512x20}\n"
                                            "- {name: b, sensor: os1-32}\n");
  EXPECT_EQ(std::get<Spinning>(rig.sensors.at(0).sensor.optics).columns_per_turn, 512U);
  EXPECT_EQ(rig.sensors.at(0).sensor.rate_hz, 20.0);
  EXPECT_EQ(rig.sensors.at(1).sensor.mode, "1024x10");
}

/// Angles of two channels, as Hesai's CSV.
std::string angles_csv(double first_deg) {
  return "Channel,Elevation,Azimuth\n1," + std::to_string(first_deg) + ",0\n2,5,-2\n";
}

TEST(RigKeys, CalibrationsApplyToTheSensorsBesideWhichTheyAreNamed) {
  const TestFolder folder;
  (void)folder.write("two.yaml",
                     "optics: {type: spinning, columns_per_turn: 8, elevation_deg: [1, 2]}\n");
  (void)folder.write("a.csv", angles_csv(3.0));
  (void)folder.write("b.csv", angles_csv(4.0));
  (void)folder.write("t.csv", "Channel,fire time(us)\n1,10\n2,20\n");
  const auto first = [](const RigSensor& one) {
    return std::get<Spinning>(one.sensor.optics).channels.at(0);
  };
  const std::string models = "models: [{model: a}]\n";
  const ScenePlan rig = planned(
      folder, models +
                  "sensors:\n- {name: a, sensor: two.yaml, calibration_file: a.csv}\n"
                  "- {name: b, sensor: two.yaml, calibration_file: b.csv, fire_time_file: t.csv}\n"
                  "- {name: c, sensor: two.yaml}\n"
                  "- name: d\n  sensor: {optics: {type: spinning, columns_per_turn: 8, "
                  "calibration_file: b.csv}}\n");
  const std::vector<double> elevations_deg = {3.0, 4.0, 1.0, 4.0};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_DOUBLE_EQ(first(rig.sensors.at(i)).elevation_rad, elevations_deg[i] * kDegree) << i;
  EXPECT_DOUBLE_EQ(first(rig.sensors.at(1)).fire_time_ns, 1e4);
  EXPECT_EQ(rig.sensors.at(1).sensor.files.size(), 3U);
  const ScenePlan single = planned(folder, models +
                                               "sensor: two.yaml\nsensor_calibration_file: a.csv\n"
                                               "sensor_fire_time_file: t.csv\n");
  EXPECT_DOUBLE_EQ(first(single.sensors.at(0)).elevation_rad, 3.0 * kDegree);
  EXPECT_DOUBLE_EQ(first(single.sensors.at(0)).fire_time_ns, 1e4);
}

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
