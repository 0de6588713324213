// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/fisher_information_file.hpp>

#include "io/yaml_files.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace glidar {
namespace {

using ::testing::HasSubstr;

/// A wall straight ahead, seen by parallel beams.
FisherInformation wall() {
  Beams beams;
  Frame frame;
  for (int i = 0; i < 9; ++i) {
    beams.directions.push_back(Eigen::Vector3d::UnitZ());
    beams.origins_m.emplace_back(i % 3 - 1, i / 3 - 1, 0.0);
    frame.ground_truth.range_m.push_back(2.0);
    frame.ground_truth.instance.push_back(0);
    frame.ground_truth.normal.push_back(-Eigen::Vector3f::UnitZ());
    frame.status.push_back(Status::hit);
  }
  return pose_information(frame, beams, {.sigma_m = 0.03});
}

TEST(InformationFile, TableListsBoundsAndDegenerateDirections) {
  const std::string text = information_text(wall());
  EXPECT_THAT(text, HasSubstr("pose information of 9 returns, sigma of ranges assumed: 0.03 m"));
  EXPECT_THAT(text, HasSubstr("translation along z  0.01 m"));  // 0.03 / sqrt(9)
  EXPECT_THAT(text, HasSubstr("translation along x  unbounded"));
  EXPECT_THAT(text, HasSubstr("rotation about x     0.7017 deg"));  // 0.03 / sqrt(6) rad
  EXPECT_THAT(text, HasSubstr("DEGENERATE   translation along y"));
  EXPECT_THAT(text, HasSubstr("DEGENERATE   rotation about z"));
}

TEST(InformationFile, JsonHoldsTheMatricesAndNullForInfinity) {
  const TestFolder folder;
  const auto path = folder.path() / "wall.fisher.json";
  write_information(wall(), path);
  std::ifstream stream(path);
  const auto json = nlohmann::json::parse(stream);
  EXPECT_EQ(json.at("returns"), 9);
  EXPECT_DOUBLE_EQ(json.at("information")[5][5].get<double>(), 9.0 / (0.03 * 0.03));
  EXPECT_TRUE(json.at("bound")[3].is_null());
  EXPECT_TRUE(json.at("condition").is_null());
  EXPECT_NEAR(json.at("bound")[5].get<double>(), 0.01, 1e-12);
  EXPECT_EQ(json.at("directions").size(), 6U);
  EXPECT_EQ(json.at("directions")[5].at("degenerate"), true);
  EXPECT_EQ(json.at("assumed_sigma_m"), 0.03);
}

}  // namespace
}  // namespace glidar
