// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// Numbers and texts; tests/io/readers checks names, types, places and values in every format.
#include <glidar/io/formats/cloud_layout.hpp>

#include <glidar/core/error.hpp>

#include <io/cloud_fixture.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace glidar {
namespace {

using ::testing::AllOf;
using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Points with these numbers in a column; of the others those of the fixture.
CloudFixture points_with(const char* column, const auto& values) {
  CloudFixture made = make_fixture(1, static_cast<std::uint32_t>(values.size()));
  fixture::add_scan_columns(made.cloud);
  for (Column& known : made.cloud.columns) {
    if (known.name == column) known.values = values;
  }
  return made;
}

template <class T>
std::vector<T> field(const CloudFixture& made, const char* layout, const char* name) {
  const PointCloud laid = apply_layout(made.cloud, layout, made.sensor, made.beams);
  return std::get<std::vector<T>>(find_column(laid, name)->values);
}

TEST(PointFieldLayout, TimesHaveTheUnitOfTheDriver) {
  const CloudFixture made = points_with("time", std::vector<std::uint32_t>{0, 55296, 99999999});
  EXPECT_THAT(field<float>(made, "velodyne", "time"), ElementsAre(0.0F, 55.296e-6F, 0.099999999F));
  EXPECT_THAT(field<std::uint32_t>(made, "ouster", "t"), ElementsAre(0, 55296, 99999999));
  EXPECT_THAT(field<std::uint32_t>(made, "autoware", "time_stamp"),
              ElementsAre(0, 55296, 99999999));
  const CloudFixture late =
      points_with("stamp", std::vector<std::int64_t>{-1, 1700000000123456789, 0});
  EXPECT_THAT(field<double>(late, "livox", "timestamp"),
              ElementsAre(-1.0, 1.7000000001234568e18, 0));
  for (const char* layout : {"robosense", "hesai"}) {
    EXPECT_THAT(field<double>(late, layout, "timestamp"),
                ElementsAre(DoubleEq(-1e-9), DoubleEq(1700000000.1234567), 0));
  }
  EXPECT_THAT(field<std::uint32_t>(made, "ouster-2022", "t"), ElementsAre(0, 55296, 99999999));
  EXPECT_THAT(field<std::uint32_t>(made, "livox-custom", "offset_time"),
              ElementsAre(0, 55296, 99999999));
}

TEST(PointFieldLayout, RangesAreMillimetresOrMetres) {
  const CloudFixture made =
      points_with("range", std::vector<double>{1.2344, 1.2346, std::nan(""), 240.0, 1e7});
  EXPECT_THAT(field<std::uint32_t>(made, "ouster", "range"),
              ElementsAre(1234, 1235, 0, 240000, 4294967295));
  const auto distance = field<float>(made, "autoware", "distance");
  EXPECT_EQ(distance[0], 1.2344F);
  EXPECT_TRUE(std::isnan(distance[2]));
}

TEST(PointFieldLayout, AnglesAreRadiansFromZeroToTwoPi) {
  const CloudFixture made = points_with("azimuth", std::vector<double>{0.0, 1.5, -1.5, -3.0});
  EXPECT_THAT(field<float>(made, "autoware", "azimuth"),
              ElementsAre(0.0F, 1.5F, 4.783185307F, 3.283185307F));
  EXPECT_FLOAT_EQ(field<float>(made, "autoware", "elevation")[2], -0.225F);
}

TEST(PointFieldLayout, ReflectivitiesArePercentUpToWhiteAndLargerForRetroReflectors) {
  const CloudFixture made = points_with(
      "intensity", std::vector<float>{0.0F, 0.5F, 1.0F, 1.01F, 31.62278F, 1000.0F, 1e6F});
  EXPECT_THAT(field<float>(made, "velodyne", "intensity"),
              ElementsAre(0.0F, 50.0F, 100.0F, 101.0F, 178.0F, 255.0F, 255.0F));
  EXPECT_THAT(field<std::uint16_t>(made, "ouster", "reflectivity"),
              ElementsAre(0, 50, 100, 101, 178, 255, 255));
  EXPECT_THAT(field<std::uint8_t>(made, "autoware", "intensity"),
              ElementsAre(0, 50, 100, 101, 178, 255, 255));
  EXPECT_THAT(field<float>(made, "livox", "intensity"),
              ElementsAre(0.0F, 75.0F, 150.0F, 151.0F, 203.0F, 255.0F, 255.0F));
  EXPECT_EQ(field<float>(made, "ouster", "intensity")[6], 1e6F);
}

TEST(PointFieldLayout, ReflectivitiesOfPulsedLightDoNotDependOnTheRange) {
  CloudFixture made = points_with("range", std::vector<double>{10.5, 25.5, 100.5, 1.0, 1.0});
  made.sensor.lidar_equation =
      LidarEquation{.reference_reflectance = 0.1, .reference_range_m = 100.0};
  made.beams.range_offset_m = 0.5;
  // 0.4 of white: S = 0.4 / 0.1 (100 / R)^2
  for (Column& column : made.cloud.columns) {
    if (column.name == "intensity") column.values = std::vector<float>{400.0F, 64.0F, 4.0F, 0, 0};
  }
  const auto found = field<std::uint8_t>(made, "autoware", "intensity");
  EXPECT_THAT(found, ElementsAre(40, 40, 40, 0, 0));
}

TEST(PointFieldLayout, ReflectivitiesAreCalibratedInClearAirAndSoLowerInFog) {
  CloudFixture made = points_with("range", std::vector<double>{10.0, 25.0, 50.0, 1.0, 1.0});
  made.sensor.lidar_equation =
      LidarEquation{.reference_reflectance = 0.1, .reference_range_m = 100.0};
  made.sensor.wavelength_m = 905e-9;
  made.sensor.weather = Weather{.visibility_m = 100.0};
  const double alpha = extinction_per_m(*made.sensor.weather, made.sensor.wavelength_m);
  const auto signal = [&](double range_m) {  // of white, behind fog
    return static_cast<float>(10.0 * std::pow(100.0 / range_m, 2.0) *
                              std::exp(-2.0 * alpha * range_m));
  };
  for (Column& column : made.cloud.columns) {
    if (column.name == "intensity")
      column.values = std::vector<float>{signal(10.0), signal(25.0), signal(50.0), 0.0F, 0.0F};
  }
  // alpha = 3.912 / 100 m by Kim's law below 500 m: exp(-0.7824), exp(-1.956), exp(-3.912)
  EXPECT_THAT(field<std::uint8_t>(made, "autoware", "intensity"), ElementsAre(46, 14, 2, 0, 0));
}

TEST(PointFieldLayout, ReflectivitiesOfCalibratedSensorsAreUnchanged) {
  CloudFixture made = points_with("intensity", std::vector<float>{0.0F, 20.0F, 100.0F, 200.0F});
  made.sensor.lidar_equation = LidarEquation{};
  const IntensityScale compensates{
      .kind = IntensityScale::Kind::linear, .gain = 0.9, .reference_m = 100.0};
  const IntensityScale spells{.kind = IntensityScale::Kind::vendor, .max_reflectance = 1000.0};
  made.sensor.noise = {compensates, RangeGaussian{.sigma_m = 0.01}, spells};
  EXPECT_THAT(field<float>(made, "velodyne", "intensity"),
              ElementsAre(0.0F, 20.0F, 100.0F, 200.0F));
  EXPECT_THAT(field<float>(made, "livox", "intensity"), ElementsAre(0.0F, 30.0F, 150.0F, 218.0F));
  made = points_with("intensity", std::vector<float>{0.0F, 0.25F, 1.0F});
  made.sensor.lidar_equation = LidarEquation{};
  made.sensor.noise = {compensates};
  EXPECT_THAT(field<float>(made, "velodyne", "intensity"), ElementsAre(0.0F, 25.0F, 100.0F));
}

TEST(PointFieldLayout, EchoesAreNumberedInLivoxTags) {
  const CloudFixture made = points_with("return", std::vector<std::uint8_t>{0, 1, 2, 3, 9});
  EXPECT_THAT(field<std::uint8_t>(made, "livox", "tag"), ElementsAre(0, 16, 32, 48, 48));
}

TEST(PointFieldLayout, AutowareIsRejectedForSeveralReturns) {
  CloudFixture made = make_fixture();
  fixture::add_scan_columns(made.cloud);
  made.beams.returns = 2;
  EXPECT_THAT(error_text([&] { apply_layout(made.cloud, "autoware", made.sensor, made.beams); }),
              HasSubstr("the sensor reports 2 returns"));
}

TEST(PointFieldLayout, UnknownFieldsAreZeroAndMissesHaveNoReturn) {
  const CloudFixture made =
      points_with("ring", std::vector<std::uint16_t>{0, 254, 255, 256, 65535});
  EXPECT_THAT(field<std::uint16_t>(made, "ouster", "ambient"), ElementsAre(0, 0, 0, 0, 0));
  EXPECT_THAT(field<std::uint8_t>(made, "livox", "tag"), ElementsAre(0, 0, 0, 0, 0));
  EXPECT_THAT(field<std::uint8_t>(made, "livox", "line"), ElementsAre(0, 254, 255, 255, 255));
  EXPECT_THAT(field<std::uint8_t>(made, "livox-custom", "line"),
              ElementsAre(0, 254, 255, 255, 255));
  EXPECT_THAT(field<std::uint8_t>(made, "ouster-2022", "ring"), ElementsAre(0, 254, 255, 255, 255));
  EXPECT_THAT(field<std::uint8_t>(made, "autoware", "return_type"), ElementsAre(1, 1, 0, 1, 1));
  EXPECT_TRUE(std::isnan(field<float>(made, "minimal", "x")[2]));
}

TEST(PointFieldLayout, MissesHaveNoReflectivity) {
  const CloudFixture made = points_with("intensity", std::vector<float>{kNaNf, 0.5F});
  for (const char* layout : {"velodyne", "livox", "robosense", "hesai"}) {
    const std::vector<float> bytes = field<float>(made, layout, "intensity");
    EXPECT_TRUE(std::isnan(bytes[0])) << layout;
    EXPECT_FALSE(std::isnan(bytes[1])) << layout;
  }
  EXPECT_EQ(field<std::uint8_t>(made, "autoware", "intensity")[0], 0);
  EXPECT_EQ(field<std::uint8_t>(made, "livox-custom", "reflectivity")[0], 0);
}

TEST(PointFieldLayout, AnUnknownNameIsReportedWithAllNamesAndTheNearest) {
  EXPECT_THAT(
      error_text([] { find_layout("velodine"); }),
      AllOf(HasSubstr("'velodine' is not known"),
            HasSubstr(
                "minimal velodyne ouster ouster-2022 livox livox-custom robosense hesai autoware"),
            HasSubstr("did you mean 'velodyne'?")));
  const testing::TestFolder folder;
  const CloudFixture made = make_fixture();
  EXPECT_THAT(
      error_text([&] { make_file_sink(folder / "a.pcd", {.layout = "x"}, made.context()); }),
      HasSubstr("cloud layout"));
}

TEST(PointFieldLayout, AMissingColumnIsReportedWithAllRequiredOnes) {
  const testing::TestFolder folder;
  const CloudFixture made = make_fixture();
  EXPECT_THAT(error_text([&] { write_cloud(made, folder / "a.pcd", {.layout = "velodyne"}); }),
              AllOf(HasSubstr("velodyne"), HasSubstr("no column time"),
                    HasSubstr("xyz intensity range ring time")));
  EXPECT_TRUE(folder.names().empty());
}

TEST(PointFieldLayout, ThePcdHeaderOfLivoxIsAsExpected) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  fixture::add_scan_columns(made.cloud);
  write_cloud(made, folder / "a.pcd", {.layout = "livox"});
  EXPECT_THAT(file_bytes(folder / "a.pcd"),
              HasSubstr("FIELDS x y z intensity tag line timestamp\nSIZE 4 4 4 4 1 1 8\n"
                        "TYPE F F F F U U F\nCOUNT 1 1 1 1 1 1 1\nWIDTH 5\nHEIGHT 4\n"));
}

TEST(PointFieldLayout, TheSidecarListsTheLayoutAndItsFields) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  fixture::add_scan_columns(made.cloud);
  const auto cloud_json = [&](const char* name) {
    write_cloud(made, folder / name, {.layout = "velodyne"});
    return nlohmann::json::parse(file_bytes(sidecar_path(folder / name))).at("files").at(0);
  };
  const nlohmann::json reported = cloud_json("a.ply");
  EXPECT_EQ(reported.at("layout"), "velodyne");
  EXPECT_EQ(reported.at("columns").size(), 6U);
  EXPECT_EQ(reported.at("columns").at(4),
            nlohmann::json::parse(R"({"name": "ring", "type": "u16", "components": ["ring"]})"));
  EXPECT_TRUE(cloud_json("a.bin").at("layout").is_null()) << "a format with fields of its own";
}

TEST(PointFieldLayout, DistantPointsCauseAWarning) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  std::get<std::vector<double>>(made.cloud.columns[0].values)[0] = 10000.0004;
  std::string reported;
  const Report report{[&reported](Severity, std::string_view text) { reported += text; }, {}};
  const SidecarContext context = made.context();
  make_file_sink(folder / "a.npz", {.layout = "minimal"}, context, report)
      ->write(made.cloud, made.frame);
  EXPECT_THAT(reported, AllOf(HasSubstr("moves its points by up to 0.0004 m"),
                              HasSubstr("without a layout .npz")));
}

}  // namespace
}  // namespace glidar
