// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/viewer.hpp>

#include <tests/viewer/viewer_fixture.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

namespace glidar::app {
namespace {

using ::testing::HasSubstr;

constexpr double kRounding = 1e-9;

/// Two boxes before a camera at (-10, 0, 0) that looks along +x.
constexpr const char* kTwoBoxes = R"(models:
  - {model: builtin:box, name: left, scale: 0.5, pose: {position: [0, 1.5, 0]}, class: a}
  - {model: builtin:box, name: right, scale: 0.5, pose: {position: [0, -1.5, 0]}, class: b}
)";
constexpr const char* kCamera = R"(
sensor: {optics: {type: pinhole, width: 32, height: 32, fov_deg: 40}}
sensor_pose: {position: [-10, 0, 0], euler_deg: {roll: -90, yaw: -90}}
)";
constexpr const char* kRig = R"(
sensors:
  - {name: lidar, sensor: VLP-16}
  - name: camera
    sensor: {optics: {type: pinhole, width: 32, height: 24, fov_deg: 40}, rate_hz: 20}
    pose: {position: [0.1, 0, 0], euler_deg: {roll: -90, yaw: -90}}
rig_pose: {position: [-10, 0, 0]}
)";

class SelectionTest : public ViewerTest {
 protected:
  void SetUp() override {
    ViewerTest::SetUp();
    flags_ = {};
    flags_.input = (folder_ / "scene.yaml").string();
    write_scene(kCamera);
  }
  void write_scene(const char* sensors) { std::ofstream(flags_.input) << kTwoBoxes << sensors; }

  Eigen::Vector3d middle_m(Viewer& viewer, std::size_t object) {
    return snapshot_of(viewer).frame.world_from_instance.at(object).translation();
  }

  /// A beam that hits the object.
  std::size_t beam_on(Viewer& viewer, std::uint32_t object) {
    const std::vector<std::uint32_t>& hits = snapshot_of(viewer).frame.ground_truth.instance;
    const auto found = std::find(hits.begin(), hits.end(), object);
    EXPECT_NE(found, hits.end());
    return static_cast<std::size_t>(found - hits.begin());
  }
};

TEST_F(SelectionTest, TheFirstObjectIsSelectedAtFirst) {
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  EXPECT_EQ(viewer.selection().object(), 0U);
  EXPECT_EQ(viewer.selected_name(), "left");
}

TEST_F(SelectionTest, KeysAndDragsActOnTheSelectedObjectOnly) {
  Viewer viewer(flags_, measurements_);
  const Frame before = snapshot_of(viewer).frame;
  viewer.select(1);
  EXPECT_EQ(viewer.selected_name(), "right");
  viewer.rotate_objects({0.25, 0.0});
  const Frame& turned = snapshot_of(viewer).frame;
  EXPECT_TRUE(turned.world_from_instance[0].isApprox(before.world_from_instance[0], 0.0));
  EXPECT_FALSE(turned.world_from_instance[1].isApprox(before.world_from_instance[1], 0.1));
  EXPECT_TRUE(middle_m(viewer, 1).isApprox(before.world_from_instance[1].translation(), kRounding))
      << "it turns about its own middle";
  viewer.type('+');
  const Eigen::Vector3d expected =
      before.world_from_sensor.translation() +
      0.05 * (middle_m(viewer, 1) - before.world_from_sensor.translation());
  EXPECT_TRUE(
      snapshot_of(viewer).frame.world_from_sensor.translation().isApprox(expected, kRounding));
}

TEST_F(SelectionTest, EachObjectKeepsItsPoseWhenAnotherIsSelectedAndResetRestoresAll) {
  Viewer viewer(flags_, measurements_);
  const Frame before = snapshot_of(viewer).frame;
  const Pose left = make_pose({0.0, 2.0, 1.0}, Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5));
  const Pose right = make_pose({0.0, -2.0, 1.0}, Eigen::Quaterniond::Identity());
  viewer.set_object_pose(0, left);
  snapshot_of(viewer);
  viewer.select(1);
  viewer.set_object_pose(1, right);
  EXPECT_TRUE(snapshot_of(viewer).frame.world_from_instance[0].isApprox(left, kRounding));
  EXPECT_TRUE(snapshot_of(viewer).frame.world_from_instance[1].isApprox(right, kRounding));
  viewer.type('r');
  EXPECT_TRUE(
      snapshot_of(viewer).frame.world_from_instance[0].isApprox(before.world_from_instance[0]));
  EXPECT_TRUE(
      snapshot_of(viewer).frame.world_from_instance[1].isApprox(before.world_from_instance[1]));
}

TEST_F(SelectionTest, AllObjectsRotateTogetherAboutTheirCentre) {
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  viewer.select({});
  EXPECT_EQ(viewer.selected_name(), "all objects");
  const Eigen::Vector3d before = middle_m(viewer, 0) - middle_m(viewer, 1);
  viewer.rotate_objects({0.25, 0.0});
  const Eigen::Vector3d after = middle_m(viewer, 0) - middle_m(viewer, 1);
  EXPECT_NEAR(before.norm(), after.norm(), kRounding);
  EXPECT_GT((before - after).norm(), 1.0);
  EXPECT_LT((middle_m(viewer, 0) + middle_m(viewer, 1)).norm(), kRounding);
}

TEST_F(SelectionTest, AClickOnAPointSelectsItsObject) {
  Viewer viewer(flags_, measurements_);
  viewer.pick(beam_on(viewer, 1));
  EXPECT_EQ(viewer.selection().object(), 1U);
  viewer.pick(0);  // a beam of the corner, which hits nothing
  EXPECT_EQ(viewer.selection().object(), 1U);
  viewer.pick(beam_on(viewer, 0));
  EXPECT_EQ(viewer.selection().object(), 0U);
}

TEST_F(SelectionTest, AnObjectThatDoesNotExistIsNotSelected) {
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  viewer.select(1);
  viewer.select(2);
  EXPECT_EQ(viewer.selection().object(), 1U);
}

TEST_F(SelectionTest, AnotherFileSelectsItsFirstObjectAndAnotherSensorKeepsTheSelection) {
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  viewer.select(1);
  viewer.use_sensor("VLP-16");
  snapshot_of(viewer);
  EXPECT_EQ(viewer.selection().object(), 1U);
  viewer.open("builtin:torus");
  snapshot_of(viewer);
  EXPECT_EQ(viewer.selection().object(), 0U);
  EXPECT_EQ(viewer.selected_name(), "torus");
}

TEST_F(SelectionTest, FramingBringsAnObjectBackIntoTheImage) {
  Viewer viewer(flags_, measurements_);
  EXPECT_EQ(snapshot_of(viewer).frame.status.size(), 32U * 32U);
  EXPECT_EQ(viewer.selection_visibility(), Visibility::inside);
  viewer.set_object_pose(0, make_pose({-20.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()));
  snapshot_of(viewer);
  EXPECT_EQ(viewer.selection_visibility(), Visibility::outside) << "it is behind the camera";
  viewer.type('f');
  snapshot_of(viewer);
  EXPECT_EQ(viewer.selection_visibility(), Visibility::inside);
  EXPECT_THAT(viewer.message, HasSubstr("framed left; aimed the sensor"));
  beam_on(viewer, 0);
}

TEST_F(SelectionTest, FramingKeepsASensorThatSeesTheObject) {
  Viewer viewer(flags_, measurements_);
  const Pose before = snapshot_of(viewer).frame.world_from_sensor;
  const double distance_m = viewer.style.orbit.distance_m;
  viewer.type('F');
  EXPECT_TRUE(snapshot_of(viewer).frame.world_from_sensor.isApprox(before, 0.0));
  EXPECT_LT(viewer.style.orbit.distance_m, distance_m) << "the view of the cloud goes near";
}

TEST_F(SelectionTest, KeepInViewAimsTheSensorAtTheMovingObject) {
  Viewer viewer(flags_, measurements_);
  const Eigen::Vector3d eye_m = snapshot_of(viewer).frame.world_from_sensor.translation();
  viewer.set_keeps_in_view(true);
  EXPECT_TRUE(snapshot_of(viewer).request.sensor_moved.isApprox(Pose::Identity(), 0.0))
      << "nothing to do while it is in view";
  viewer.set_object_pose(0, make_pose({-10.0, 9.0, 1.0}, Eigen::Quaterniond::Identity()));
  ASSERT_TRUE(wait_until(viewer, [&] {
    return viewer.is_current() && viewer.selection_visibility() == Visibility::inside;
  }));
  EXPECT_TRUE(viewer.snapshot()->frame.world_from_sensor.translation().isApprox(eye_m, kRounding));
  viewer.set_keeps_in_view(false);
  viewer.set_object_pose(0, make_pose({-10.0, -9.0, 1.0}, Eigen::Quaterniond::Identity()));
  snapshot_of(viewer);
  EXPECT_EQ(viewer.selection_visibility(), Visibility::outside);
}

TEST_F(SelectionTest, AllSensorsOfARigAreShownOneAtATime) {
  write_scene(kRig);
  Viewer viewer(flags_, measurements_);
  EXPECT_EQ(snapshot_of(viewer).beams->rows, 16U) << "the first of the file";
  EXPECT_EQ(viewer.style.quantity, Quantity::range);
  viewer.select_sensor(1);
  const Snapshot& camera = snapshot_of(viewer);
  EXPECT_EQ(camera.beams->cols, 32U);
  EXPECT_EQ(camera.frame.sensor_id, 1U);
  EXPECT_NEAR(camera.frame.world_from_sensor.translation().x(), -9.9, kRounding);
  EXPECT_EQ(viewer.style.quantity, Quantity::depth);
  EXPECT_EQ(viewer.points().size(), camera.beams->size());
  viewer.select_sensor(2);
  EXPECT_EQ(viewer.request().sensor_index, 1U) << "there is none";
}

TEST_F(SelectionTest, TheSensorsOfARigMoveTogether) {
  write_scene(kRig);
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  viewer.select_sensor(1);
  Pose pose = snapshot_of(viewer).frame.world_from_sensor;
  pose.translation() += Eigen::Vector3d(1.0, 2.0, 3.0);
  viewer.set_sensor_pose(pose);
  snapshot_of(viewer);
  viewer.select_sensor(0);
  const Eigen::Vector3d lidar = snapshot_of(viewer).frame.world_from_sensor.translation();
  EXPECT_TRUE(lidar.isApprox(Eigen::Vector3d(-9.0, 2.0, 3.0), kRounding));
}

TEST_F(SelectionTest, AMeasurementOfARigSensorIsThatOfTheSensorAlone) {
  write_scene(kRig);
  Viewer viewer(flags_, measurements_);
  snapshot_of(viewer);
  viewer.select_sensor(1);
  const std::vector<float> in_rig = snapshot_of(viewer).frame.intensity;
  RenderFlags alone = flags_;
  alone.sensor_name = "camera";
  Viewer other(alone, measurements_);
  EXPECT_EQ(snapshot_of(other).frame.intensity, in_rig);
  EXPECT_EQ(snapshot_of(other).prepared->sensors.size(), 1U);
}

}  // namespace
}  // namespace glidar::app
