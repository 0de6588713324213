// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/math/constants.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

/// Two beams: the first hits at 2 m, the second misses.
struct Fixture {
  Beams beams;
  Frame frame;
  Scene scene;

  Fixture() {
    beams.rows = 1;
    beams.cols = 2;
    beams.frame_id = "camera_optical_frame";
    beams.directions = {Eigen::Vector3d(0.6, 0.0, 0.8), Eigen::Vector3d::UnitZ()};
    scene.class_names = {"unlabelled", "rock"};
    scene.instances.push_back({.name = "a", .id = 7, .class_id = 1, .materials = {}});
    frame.rows = 1;
    frame.cols = 2;
    frame.frame_id = beams.frame_id;
    frame.range_m = {2.0, kNaN};
    frame.intensity = {0.5F, 0.0F};
    frame.status = {Status::hit, Status::miss};
    frame.ground_truth.range_m = frame.range_m;
    frame.ground_truth.instance = {0, kInvalidId};
    frame.ground_truth.primitive = {42, kInvalidId};
  }

  PointCloud cloud(const std::vector<std::string>& columns,
                   const OutputFrame& in = {"c", Pose::Identity()}) {
    PointCloud made;
    make_point_cloud(frame, beams, scene, in, columns, made);
    return made;
  }
};

template <class T>
const std::vector<T>& values(const PointCloud& cloud, std::string_view name) {
  return std::get<std::vector<T>>(find_column(cloud, name)->values);
}

TEST(PointCloud, PointsAreOnTheirBeams) {
  const PointCloud cloud = Fixture().cloud({"xyz", "depth", "range"});
  const auto& xyz = values<double>(cloud, "xyz");
  EXPECT_DOUBLE_EQ(xyz[0], 1.2);
  EXPECT_DOUBLE_EQ(xyz[2], 1.6);
  EXPECT_TRUE(std::isnan(xyz[3]));
  EXPECT_DOUBLE_EQ(values<double>(cloud, "depth")[0], 1.6);
  EXPECT_DOUBLE_EQ(values<double>(cloud, "range")[0], 2.0);
}

TEST(PointCloud, IncludesTheBeamOrigins) {
  Fixture f;
  f.beams.origins_m = {Eigen::Vector3d(0.0, 1.0, 0.5), Eigen::Vector3d::Zero()};
  const PointCloud cloud = f.cloud({"xyz", "depth"});
  EXPECT_DOUBLE_EQ(values<double>(cloud, "xyz")[1], 1.0);
  EXPECT_DOUBLE_EQ(values<double>(cloud, "depth")[0], 2.1);
}

TEST(PointCloud, IsInTheNamedCoordinateFrame) {
  Fixture f;
  f.frame.world_from_sensor.translation() = Eigen::Vector3d(0.0, 0.0, 10.0);
  const OutputFrame world{"world", f.frame.world_from_sensor};
  const PointCloud cloud = f.cloud({"xyz"}, world);
  EXPECT_EQ(cloud.frame_id, "world");
  EXPECT_DOUBLE_EQ(values<double>(cloud, "xyz")[2], 11.6);
  EXPECT_TRUE(cloud.world_from_cloud.isApprox(Pose::Identity()));
}

TEST(PointCloud, HasIdsForHitsAndInvalidIdsForMisses) {
  const PointCloud cloud =
      Fixture().cloud({"instance", "class", "primitive", "status", "row", "col"});
  EXPECT_THAT(values<std::uint32_t>(cloud, "instance"), ::testing::ElementsAre(7, kInvalidId));
  EXPECT_THAT(values<std::uint32_t>(cloud, "class"), ::testing::ElementsAre(1, kInvalidId));
  EXPECT_THAT(values<std::uint32_t>(cloud, "primitive"), ::testing::ElementsAre(42, kInvalidId));
  EXPECT_THAT(values<std::uint8_t>(cloud, "status"), ::testing::ElementsAre(0, 1));
  EXPECT_THAT(values<std::uint32_t>(cloud, "col"), ::testing::ElementsAre(0, 1));
}

TEST(PointCloud, HasFiringTimes) {
  Fixture f;
  f.frame.stamp_ns = -5;
  EXPECT_THAT(values<std::int64_t>(f.cloud({"stamp"}), "stamp"), ::testing::ElementsAre(-5, -5));
  f.beams.times_ns = {0, 4294967295};
  f.frame.stamp_ns = 1700000000123456789;
  EXPECT_THAT(values<std::int64_t>(f.cloud({"stamp"}), "stamp"),
              ::testing::ElementsAre(1700000000123456789, 1700000004418424084));
}

TEST(PointCloud, HasAzimuthAndElevationOfACamera) {
  Fixture f;  // 0.6 to the right, 0.8 ahead
  f.beams.directions[1] = Eigen::Vector3d(0.0, -0.6, 0.8);
  const PointCloud cloud = f.cloud({"azimuth", "elevation"});
  EXPECT_DOUBLE_EQ(values<double>(cloud, "azimuth")[0], -std::atan2(0.6, 0.8));
  EXPECT_DOUBLE_EQ(values<double>(cloud, "elevation")[0], 0.0);
  EXPECT_DOUBLE_EQ(values<double>(cloud, "azimuth")[1], 0.0);
  EXPECT_DOUBLE_EQ(values<double>(cloud, "elevation")[1], std::asin(0.6));
}

TEST(PointCloud, HasAzimuthAndElevationOfALidarInAnyOutputFrame) {
  Fixture f;
  f.beams.boresight = Eigen::Vector3d::UnitX();
  f.beams.directions = {Eigen::Vector3d(-0.6, -0.8, 0.0), Eigen::Vector3d::Constant(kNaN)};
  const OutputFrame turned{"c", make_pose({1, 2, 3}, Eigen::Quaterniond(0.0, 0.0, 0.0, 1.0))};
  const PointCloud cloud = f.cloud({"azimuth", "elevation"}, turned);
  EXPECT_DOUBLE_EQ(values<double>(cloud, "azimuth")[0], std::atan2(-0.8, -0.6));
  EXPECT_TRUE(std::isnan(values<double>(cloud, "azimuth")[1]));
  EXPECT_TRUE(std::isnan(values<double>(cloud, "elevation")[1]));
}

TEST(PointCloud, IsIdenticalForAnyNumberOfThreads) {
  constexpr std::uint32_t kSide = 300;  // more than one parallel task
  Fixture fixture;
  fixture.beams.rows = fixture.beams.cols = fixture.frame.rows = fixture.frame.cols = kSide;
  const std::size_t size = std::size_t{kSide} * kSide;
  fixture.beams.directions.assign(size, Eigen::Vector3d(0.6, 0.0, 0.8));
  fixture.frame.intensity.assign(size, 0.5F);
  fixture.frame.range_m.resize(size);
  for (std::size_t i = 0; i < size; ++i) fixture.frame.range_m[i] = static_cast<double>(i) / 7.0;
  const std::vector<std::string> columns = {"xyz", "intensity", "range", "row"};
  const PointCloud alone = fixture.cloud(columns);
  ThreadPool thread_pool(3);
  const PointCloud together =
      fixture.cloud(columns, {.frame_id = "c", .thread_pool = &thread_pool});
  for (std::size_t c = 0; c < columns.size(); ++c) {
    EXPECT_EQ(together.columns[c].values, alone.columns[c].values) << columns[c];
  }
}

TEST(PointCloud, RejectsUnknownAndUncastColumns) {
  Fixture f;
  EXPECT_THAT(error_text([&] { f.cloud({"intensty"}); }),
              ::testing::HasSubstr("did you mean 'intensity'?"));
  EXPECT_THAT(error_text([&] { f.cloud({"normal"}); }),
              ::testing::HasSubstr("the frame was cast without it"));
}

TEST(PointCloud, RejectsBeamsOfAnotherFrame) {
  Fixture f;
  f.beams.cols = 3;
  EXPECT_THAT(error_text([&] { f.cloud({"range"}); }),
              ::testing::HasSubstr("a frame of 1 x 2 and beams of 1 x 3"));
}

TEST(PointCloud, RequiresTheHitFieldsOfItsColumns) {
  const std::vector<std::string> names = {"xyz", "normal", "colour"};
  const HitColumnMask hit_columns = hit_columns_for(names);
  EXPECT_TRUE(hit_columns.normal);
  EXPECT_TRUE(hit_columns.colour);
  EXPECT_FALSE(hit_columns.shading_normal);
  EXPECT_FALSE(hit_columns.object_point);
}

TEST(RemoveInvalidPoints, KeepsTheHitsOnly) {
  PointCloud cloud;
  cloud.columns = {{"other", {"a"}, std::vector<double>(9)}};  // its memory is reused
  remove_invalid_points(Fixture().cloud({"xyz", "instance", "stamp"}), cloud);
  EXPECT_EQ(cloud.rows, 1U);
  EXPECT_EQ(cloud.cols, 1U);
  EXPECT_THAT(values<std::uint32_t>(cloud, "instance"), ::testing::ElementsAre(7));
  EXPECT_EQ(values<double>(cloud, "xyz").size(), 3U);
  EXPECT_EQ(values<std::int64_t>(cloud, "stamp").size(), 1U);
}

TEST(RemoveInvalidPoints, RequiresCoordinates) {
  PointCloud cloud;
  EXPECT_THROW(remove_invalid_points(Fixture().cloud({"range"}), cloud), Error);
}

}  // namespace
}  // namespace glidar
