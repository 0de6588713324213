// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <tests/viewer/viewer_fixture.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>

namespace glidar::app {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

double distance_m(const Snapshot& snapshot) {
  return snapshot.frame.world_from_sensor.translation().norm();
}

TEST_F(ViewerTest, ShowsWhatTheSensorMeasures) {
  Viewer viewer(flags_, measurements_);
  const Snapshot& snapshot = snapshot_of(viewer);
  EXPECT_EQ(snapshot.beams->size(), 32U * 32U);
  EXPECT_EQ(viewer.picture().colours.size(), snapshot.beams->size());
  EXPECT_GT(viewer.summary().hits, 100U);
  EXPECT_FALSE(viewer.guides().empty());
  std::size_t points = 0;
  for (const Eigen::Vector3f& point : viewer.points()) points += std::isnan(point.x()) ? 0 : 1;
  EXPECT_EQ(points, viewer.summary().hits);
}

TEST_F(ViewerTest, PlusAndMinusMoveTheSensorByATwentiethOfTheDistance) {
  Viewer viewer(flags_, measurements_);
  const Eigen::Vector3d middle = bounds(snapshot_of(viewer).prepared->scene).center();
  const auto away_m = [&] {
    return (snapshot_of(viewer).frame.world_from_sensor.translation() - middle).norm();
  };
  const double before_m = away_m();
  viewer.type('+');
  EXPECT_NEAR(away_m() / before_m, 0.95, 1e-9);
  viewer.type('-');
  EXPECT_NEAR(away_m() / before_m, 1.0, 1e-9);
}

TEST_F(ViewerTest, ADragRotatesTheObjectAboutItsCentreAndResetUndoesIt) {
  Viewer viewer(flags_, measurements_);
  const Pose before = snapshot_of(viewer).frame.world_from_instance[0];
  const Eigen::Vector3d middle = bounds(viewer.snapshot()->prepared->scene).center();
  viewer.rotate_objects({0.25, 0.0});
  const Pose turned = snapshot_of(viewer).frame.world_from_instance[0];
  EXPECT_TRUE((turned * (before.inverse() * middle)).isApprox(middle, 1e-9));
  const Eigen::AngleAxisd by((turned * before.inverse()).linear());
  EXPECT_NEAR(by.angle(), 0.25 * std::numbers::pi, 1e-9);
  const Eigen::Vector3d up = -viewer.snapshot()->frame.world_from_sensor.linear().col(1);
  EXPECT_TRUE(by.axis().isApprox(up, 1e-9)) << "the near side follows the pointer to the right";
  viewer.type('r');
  EXPECT_TRUE(snapshot_of(viewer).frame.world_from_instance[0].isApprox(before, 0.0));
}

TEST_F(ViewerTest, KeepsARotationThroughTenThousandSmallDrags) {
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  for (int i = 0; i < 10'000; ++i) viewer.rotate_objects({0.001, 0.0007});
  EXPECT_TRUE(is_rigid(snapshot_of(viewer).frame.world_from_instance[0]));
}

TEST_F(ViewerTest, SetsTypedPosesOfSensorAndObject) {
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  const Pose sensor = look_at({9.0, 1.0, 2.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  viewer.set_sensor_pose(sensor);
  EXPECT_TRUE(snapshot_of(viewer).frame.world_from_sensor.isApprox(sensor, 1e-12));
  const Pose object = make_pose({0.1, 0.2, 0.3}, Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5));
  viewer.set_object_pose(0, object);
  EXPECT_TRUE(snapshot_of(viewer).frame.world_from_instance[0].isApprox(object, 1e-12));
}

TEST_F(ViewerTest, SpacePausesAndFramesFollowTheSensorsRate) {
  flags_.motion.object_rate_rad_s = Eigen::Vector3d::UnitZ();
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  EXPECT_TRUE(viewer.is_moving());
  viewer.advance(0.5);
  EXPECT_EQ(snapshot_of(viewer).frame.number, 15U) << "at 30 Hz";
  viewer.type(' ');
  EXPECT_FALSE(viewer.is_playing());
  viewer.advance(10.0);
  EXPECT_EQ(viewer.request().number, 15U);
  EXPECT_EQ(viewer.next_frame_s(), std::nullopt);
  viewer.type(' ');
  viewer.advance(0.01);
  EXPECT_NEAR(viewer.next_frame_s().value(), 16.0 / 30.0 - 0.51, 1e-9);
}

TEST_F(ViewerTest, SpaceSaysWhenNothingMoves) {
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  viewer.type(' ');
  EXPECT_THAT(viewer.message, HasSubstr("nothing moves"));
}

TEST_F(ViewerTest, NoiseCanBeSwitchedAndTheSeedChangesIt) {
  flags_.sensor = {};
  flags_.sensor.file = "Kinect-v1";
  Viewer viewer(flags_, measurements_);
  const auto ranges = [&] { return snapshot_of(viewer).frame.range_m; };
  const auto equal = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
      return x == y || (std::isnan(x) && std::isnan(y));
    });
  };
  const std::vector<double> noisy = ranges();
  viewer.set_seed(2);
  EXPECT_FALSE(equal(ranges(), noisy));
  viewer.set_seed(1);
  EXPECT_TRUE(equal(ranges(), noisy)) << "the same seed, the same bytes";
  viewer.set_noise(false);
  EXPECT_FALSE(equal(ranges(), noisy));
  EXPECT_TRUE(viewer.snapshot()->sensor->noise.empty());
}

TEST_F(ViewerTest, ChangesSensorAndRenderer) {
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  viewer.use_renderer("gpu");
  EXPECT_EQ(snapshot_of(viewer).prepared->renderer->name(), "gpu");
  viewer.use_renderer("rays");
  viewer.use_sensor("VLP-16");
  EXPECT_EQ(snapshot_of(viewer).beams->rows, 16U);
  EXPECT_EQ(viewer.style.quantity, Quantity::range) << "depth means nothing to a scanner";
}

TEST_F(ViewerTest, ReportsErrorsAndKeepsThePreviousSession) {
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  viewer.use_sensor("VLP-16");
  snapshot_of(viewer);
  viewer.use_renderer("raster");  // scanners are not a central projection
  ASSERT_TRUE(wait_until(viewer, [&] { return !viewer.errors.empty(); }));
  EXPECT_THAT(viewer.errors.front(), HasSubstr("--renderer rays"));
  viewer.open((folder_ / "missing.obj").string());
  ASSERT_TRUE(wait_until(viewer, [&] { return viewer.errors.size() > 1; }));
  EXPECT_THAT(viewer.errors.back(), HasSubstr("missing.obj"));
  viewer.use_renderer("rays");
  EXPECT_GT(snapshot_of(viewer).beams->size(), 0U);
}

TEST_F(ViewerTest, OpensADroppedFileWithInitialPoses) {
  flags_.pose.eye_m = Eigen::Vector3d(100.0, 0.0, 0.0);
  Viewer viewer(flags_, measurements_);
  EXPECT_NEAR(distance_m(snapshot_of(viewer)), 100.0, 1e-9);
  viewer.open("builtin:torus");
  EXPECT_LT(distance_m(snapshot_of(viewer)), 50.0);
  EXPECT_EQ(viewer.snapshot()->prepared->scene.instances[0].name, "torus");
  EXPECT_EQ(viewer.snapshot()->beams->cols, 32U) << "the sensor stays";
}

TEST_F(ViewerTest, SavesTheCloudUnderANewNameEachTime) {
  flags_.output.legacy_name = (folder_ / "view").string();
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  viewer.type('s');
  viewer.type('+');
  viewer.type('s');
  ASSERT_TRUE(wait_until(
      viewer, [&] { return std::filesystem::exists(folder_ / "view_000001.transform"); }));
  const auto depth_in = [&](const char* file) {
    std::ifstream text(folder_ / file);
    std::array<double, 12> numbers{};
    for (double& number : numbers) text >> number;
    return numbers[11];
  };
  EXPECT_TRUE(std::filesystem::exists(folder_ / "view.pcd"));
  EXPECT_LT(depth_in("view_000001.transform"), depth_in("view.transform"));
}

TEST_F(ViewerTest, ReportsWhyAFileCannotBeSaved) {
  flags_.output.paths = {(folder_ / "no_such_folder" / "x.pcd").string()};
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  viewer.type('s');
  ASSERT_TRUE(wait_until(viewer, [&] { return !viewer.errors.empty(); }));
  EXPECT_THAT(viewer.errors.front(), HasSubstr("no_such_folder"));
}

TEST_F(ViewerTest, TracesAPickedPointAgainAfterItMoves) {
  flags_.motion.object_rate_rad_s = Eigen::Vector3d::UnitZ();
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  const std::size_t middle = 16 * 32 + 16;
  viewer.pick(middle);
  EXPECT_FALSE(viewer.is_playing()) << "time stops";
  ASSERT_TRUE(wait_until(viewer, [&] { return !viewer.trace.empty(); }));
  EXPECT_THAT(viewer.trace, HasSubstr("row 16, col 16"));
  EXPECT_THAT(viewer.trace, HasSubstr("object 'asteroid'"));
  const std::string before = viewer.trace;
  viewer.type('+');
  EXPECT_TRUE(wait_until(viewer, [&] { return viewer.trace != before; }));
  viewer.pick({});
  EXPECT_THAT(viewer.trace, IsEmpty());
}

TEST_F(ViewerTest, UnknownKeysDoNothing) {
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  const MeasureRequest before = viewer.request();
  for (const unsigned letter : {'x', '1', ';'}) viewer.type(letter);
  viewer.type(0x1F600);
  EXPECT_TRUE(viewer.request() == before);
}

TEST_F(ViewerTest, EndsDuringAMeasurement) {
  for (int i = 0; i < 20; ++i) {
    MeasurementThread measurements(console_, [] {});
    Viewer viewer(flags_, measurements);
    viewer.show_frame(static_cast<std::uint32_t>(i));
  }
}

TEST_F(ViewerTest, IsCurrentOnceTheRequestIsMeasured) {
  Viewer viewer(flags_, measurements_);
  EXPECT_FALSE(viewer.is_current());
  ASSERT_TRUE(wait_until(viewer, [&] { return viewer.is_current(); }));
  viewer.set_seed(7);
  EXPECT_FALSE(viewer.is_current());
  ASSERT_TRUE(wait_until(viewer, [&] { return viewer.is_current(); }));
  EXPECT_EQ(viewer.snapshot()->request.seed, 7U);
}

TEST_F(ViewerTest, IsCurrentWhilePlayingEvenIfMeasuringIsSlow) {
  flags_.motion.object_rate_rad_s = Eigen::Vector3d::UnitZ();
  Viewer viewer(flags_, measurements_);
  ASSERT_TRUE(wait_until(viewer, [&] { return viewer.is_current(); }));
  viewer.show_frame(1000);
  EXPECT_TRUE(viewer.is_current());
  viewer.toggle_play();
  EXPECT_FALSE(viewer.is_current());
  EXPECT_TRUE(wait_until(viewer, [&] { return viewer.is_current(); }));
}

}  // namespace
}  // namespace glidar::app
