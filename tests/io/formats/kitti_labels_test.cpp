// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

#include <glidar/io/formats/kitti_labels.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <io/cloud_fixture.hpp>
#include <support/data.hpp>

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

namespace glidar {
namespace {

/// The numbers of the only line, after its type.
std::vector<double> only_line(const std::string& labels) {
  std::istringstream line(labels);
  std::string type;
  line >> type;
  std::vector<double> numbers;
  for (double number = 0.0; line >> number;) numbers.push_back(number);
  EXPECT_EQ(numbers.size(), 14U) << labels;
  return numbers;
}

TEST(KittiLabels, BoxesContainAllPartsOfAMeshWithSeveralOrigins) {
  Scene scene;
  Mesh mesh;  // a corner at (0, 0, 0) and two near (100, 20, 4), each relative to its own origin
  mesh.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, 0}, {0, -1, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  mesh.origins = {{0, 0, {0.0, 0.0, 0.0}}, {3, 1, {100.0, 20.0, 4.0}}};
  validate(mesh);
  scene.meshes = {mesh};
  scene.instances.resize(1);
  scene.instances[0].class_id = 1;
  scene.class_names = {"unlabelled", "crane"};
  Sensor sensor;
  sensor.optics = Spinning{};
  Frame frame;
  frame.world_from_sensor = make_pose({-10.0, 0.0, 0.0}, Eigen::Quaterniond::Identity());
  frame.world_from_instance = {Pose::Identity()};
  frame.ground_truth.instance = {0};
  frame.boxes = {{.instance = 0}};
  const std::vector<double> box = only_line(kitti_labels(scene, kitti_camera(sensor), frame));
  // h w l: the object's z, y and x; x y z of the lower face in the camera's frame: right, down,
  // ahead
  const std::vector<double> expected = {4.0, 20.0, 100.0, -10.0, 0.0, 60.0};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(box.at(7 + i), expected[i], 1e-6);
}

TEST(KittiLabels, ObjectsWhoseClassHasNoBoxesHaveNoLine) {
  Scene scene = testing::scene_of(make_builtin_model("box"));
  scene.instances[0].class_id = 1;
  scene.class_names = {"unlabelled", "road"};
  Sensor sensor;
  sensor.optics = Spinning{};
  Frame frame;
  frame.world_from_sensor = make_pose({-10.0, 0.0, 0.0}, Eigen::Quaterniond::Identity());
  frame.world_from_instance = {Pose::Identity()};
  frame.ground_truth.instance = {0};
  EXPECT_EQ(kitti_labels(scene, kitti_camera(sensor), frame), "");
  frame.boxes = {{.instance = 0}};
  EXPECT_TRUE(kitti_labels(scene, kitti_camera(sensor), frame).starts_with("road "));
}

}  // namespace
}  // namespace glidar
