// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/scene_builder.hpp>
#include <glidar/math/constants.hpp>

#include "io/yaml_files.hpp"

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

}  // namespace
}  // namespace glidar
