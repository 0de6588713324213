// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/imu_samples_file.hpp>

#include <nlohmann/json.hpp>

#include "io/yaml_files.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

namespace glidar {
namespace {

using ::testing::HasSubstr;

ImuSamples two_samples() {
  ImuSamples samples;
  samples.t_ns = {0, 5'000'000};
  samples.ground_truth.angular_velocity_rad_s = {{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}};
  samples.ground_truth.specific_force_m_s2 = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  samples.ground_truth.velocity_m_s = {{7.0, 0.0, 0.0}, {8.0, 0.0, 0.0}};
  samples.ground_truth.world_from_imu.resize(2, Pose::Identity());
  measure({}, {}, samples);
  return samples;
}

std::string content_of(const std::filesystem::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(ImuSamplesFile, CsvHasAColumnForEveryNumber) {
  const TestFolder folder;
  const auto path = folder.path() / "walk.imu.csv";
  write_imu_samples(two_samples(), {.name = "imu", .imu = {}, .run = {}}, path);
  EXPECT_EQ(content_of(path),
            imu_csv_header() +
                "\n0,0.1,0.2,0.3,1,2,3,0.1,0.2,0.3,1,2,3,0,0,0,0,0,0,7,0,0,0,0,0,1,0,0,0\n"
                "5000000,0.4,0.5,0.6,4,5,6,0.4,0.5,0.6,4,5,6,0,0,0,0,0,0,8,0,0,0,0,0,1,0,0,0\n");
  EXPECT_THAT(imu_csv_header(), HasSubstr("t_ns,gyro_x,gyro_y,gyro_z,accel_x"));
}

TEST(ImuSamplesFile, IsDescribedBesideIt) {
  const TestFolder folder;
  const auto path = folder.path() / "walk.imu.npz";
  write_imu_samples(two_samples(), {.name = "front", .imu = {}, .run = {.seed = 9}}, path);
  const auto json = nlohmann::json::parse(content_of(path.string() + ".json"));
  EXPECT_EQ(json["name"], "front");
  EXPECT_EQ(json["seed"], 9);
  EXPECT_EQ(json["gravity_m_s2"][2], -9.80665);
  EXPECT_EQ(json["imu"]["rate_hz"], 200.0);
  EXPECT_EQ(json["gyroscope_matrix"][1][1], 1.0);
  EXPECT_EQ(json["columns"]["accel"]["unit"], "m/s^2");
}

TEST(ImuSamplesFile, AreKnownByTheirSuffix) {
  EXPECT_TRUE(is_imu_samples_path("a/b.IMU.csv"));
  EXPECT_TRUE(is_imu_samples_path("b.imu.npz"));
  EXPECT_FALSE(is_imu_samples_path("b.csv"));
  EXPECT_FALSE(is_imu_samples_path(".imu.csv"));
  const TestFolder folder;
  EXPECT_THAT(error_of(folder, [&] { write_imu_samples(two_samples(), {}, "b.imu.txt"); }),
              HasSubstr(".imu.csv .imu.npz"));
}

TEST(ImuSamplesFile, ReplacesNoInput) {
  const TestFolder folder;
  const auto path = folder.write("in.imu.csv", "x");
  const std::vector<std::string> read = {path.string()};
  EXPECT_NE(error_of(folder, [&] { write_imu_samples(two_samples(), {}, path, read); }),
            "no error");
  EXPECT_EQ(content_of(path), "x");
}

}  // namespace
}  // namespace glidar
