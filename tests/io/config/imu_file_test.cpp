// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/imu_file.hpp>

#include <glidar/io/config/scene_plan.hpp>

#include "io/yaml_files.hpp"

#include <gmock/gmock.h>

#include <array>

namespace glidar {
namespace {

using ::testing::HasSubstr;

/// Numbers of the manufacturers' data sheets, copied independently of the files.
struct PublishedImu {
  const char* name;
  double rate_hz;
  double gyroscope_range_deg_s;
  double accelerometer_range_g;
};
constexpr std::array kPublishedImus = std::to_array<PublishedImu>(
    {{"ADIS16448", 200, 1000, 18}, {"BMI088", 200, 2000, 24}, {"ICM-20948", 100, 250, 2}});

TEST(ImuPresets, AreAllTestedAndHaveTheNumbersOfTheirSheets) {
  ASSERT_EQ(imu_preset_files().size(), kPublishedImus.size());
  for (const PublishedImu& published : kPublishedImus) {
    const Imu imu = load_imu_file(find_imu_file(published.name));
    EXPECT_EQ(imu.rate_hz, published.rate_hz) << published.name;
    EXPECT_NEAR(imu.gyroscope.range / kDegree, published.gyroscope_range_deg_s, 1e-9);
    EXPECT_NEAR(imu.accelerometer.range / kStandardGravity_m_s2, published.accelerometer_range_g,
                1e-12);
    EXPECT_GT(imu.gyroscope.noise_density, 0.0);
    EXPECT_GT(imu.accelerometer.noise_density, 0.0);
    validate(imu);
  }
}

TEST(ImuPresets, StateASourceOrThatThereIsNone) {
  for (const std::filesystem::path& file : imu_preset_files()) {
    for (const DatasheetEntry& entry : load_imu_datasheet(file).entries) {
      if (entry.key == "name") continue;
      EXPECT_TRUE(!entry.source.empty() || !entry.verified) << file << " " << entry.key;
    }
  }
}

TEST(ImuPresets, SurviveTheirDocuments) {
  for (const std::filesystem::path& file : imu_preset_files()) {
    const Imu imu = load_imu_file(file);
    const Imu again = parse_imu(imu_document(imu));
    EXPECT_EQ(again.name, imu.name);
    EXPECT_EQ(again.gyroscope.bias_instability, imu.gyroscope.bias_instability);
    EXPECT_EQ(again.gyroscope.range, imu.gyroscope.range);
    EXPECT_EQ(again.accelerometer.noise_density, imu.accelerometer.noise_density);
    EXPECT_EQ(again.accelerometer.resolution, imu.accelerometer.resolution);
  }
}

TEST(ImuFile, ReadsUnitsOfDataSheets) {
  const Imu imu = parse_imu(
      "{rate_hz: 400, gyroscope: {bias_instability_deg_h: 3600, range_deg_s: 180},"
      " accelerometer: {noise_density_ug_sqrt_hz: 100, turn_on_bias_mg: 2}}");
  EXPECT_NEAR(imu.gyroscope.bias_instability, kDegree, 1e-17);
  EXPECT_NEAR(imu.gyroscope.range, 180.0 * kDegree, 1e-15);
  EXPECT_NEAR(imu.accelerometer.noise_density, 980.665e-6, 1e-18);
  EXPECT_NEAR(imu.accelerometer.turn_on_bias, 0.0196133, 1e-17);
}

TEST(ImuFile, ErrorsStateThePlaceAndTheNearestKey) {
  const TestFolder folder;
  const auto error = [&](const std::string& content) {
    const auto file = folder.write("imu.yaml", content);
    return error_of(folder, [&] { load_imu_file(file); });
  };
  EXPECT_THAT(error("rate_hz: 0\n"), HasSubstr("imu.yaml:1:10: rate_hz"));
  EXPECT_THAT(error("gyroscope:\n  range_degs: 4\n"), HasSubstr("imu.yaml:2"));
  EXPECT_THAT(error("gyroscope:\n  range_degs: 4\n"), HasSubstr("range_deg_s"));
}

ScenePlan plan_of(const TestFolder& folder, const std::string& imus) {
  return read_scene_plan(folder.write("scene.yaml", "models: [{model: a}]\n" + imus), {});
}

TEST(RigImus, HaveNamesPosesAndGravity) {
  const TestFolder folder;
  folder.write("own.yaml", "rate_hz: 50\n");
  const ScenePlan plan = plan_of(folder,
                                 "imus:\n"
                                 "  - {name: a, imu: BMI088, pose: {position: [0, 0, 2]}}\n"
                                 "  - {name: b, imu: {rate_hz: 10}}\n"
                                 "  - {name: c, imu: own.yaml}\n"
                                 "gravity_m_s2: [0, 0, -1.62]\n");
  ASSERT_EQ(plan.imus.size(), 3U);
  EXPECT_EQ(plan.imus[0].name, "a");
  EXPECT_EQ(plan.imus[0].imu.rate_hz, 200.0);
  EXPECT_EQ(plan.imus[0].rig_from_imu.translation(), Eigen::Vector3d(0, 0, 2));
  EXPECT_EQ(plan.imus[1].imu.rate_hz, 10.0);
  EXPECT_EQ(plan.imus[2].imu.rate_hz, 50.0);
  EXPECT_EQ(plan.gravity_m_s2, Eigen::Vector3d(0, 0, -1.62));
  EXPECT_EQ(plan_of(folder, "").gravity_m_s2, standard_gravity_m_s2());
}

TEST(RigImus, ErrorsStateThePlace) {
  const TestFolder folder;
  const auto error = [&](const std::string& imus) {
    return error_of(folder, [&] { plan_of(folder, imus); });
  };
  EXPECT_THAT(error("imus: [{name: a, imu: BMI08}]\n"), HasSubstr("did you mean BMI088"));
  EXPECT_THAT(error("imus: [{name: a, imu: BMI08}]\n"), HasSubstr("scene.yaml:2:"));
  EXPECT_THAT(error("imus: [{name: a b, imu: BMI088}]\n"), HasSubstr("up to 31 letters"));
  EXPECT_THAT(error("imus: [{name: a}]\n"), HasSubstr("imu"));
  EXPECT_THAT(error("imus: [{name: a, imu: BMI088}, {name: a, imu: BMI088}]\n"),
              HasSubstr("given twice"));
  EXPECT_THAT(error("sensors: [{name: a, sensor: VLP-16}]\nimus: [{name: a, imu: BMI088}]\n"),
              HasSubstr("given twice"));
  EXPECT_THAT(error("gravity_m_s2: [0, 0]\n"), HasSubstr("gravity_m_s2"));
}

TEST(TrajectoryKeys, SelectTheInterpolation) {
  const TestFolder folder;
  folder.write("t.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n");
  const ScenePlan plan = plan_of(
      folder,
      "sensor: VLP-16\nsensor_motion: {trajectory: {file: t.tum, interpolation: spline}}\n");
  ASSERT_TRUE(plan.rig_motion);
  EXPECT_EQ(std::get<TimedPoses>(*plan.rig_motion).interpolation(), Interpolation::spline);
}

}  // namespace
}  // namespace glidar
