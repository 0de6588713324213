// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Objects that some sensors of a rig do not see.
#include <glidar/core/error.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <glidar/simulate/simulator.hpp>
#include <support/data.hpp>
#include <support/parameter_name.hpp>
#include <support/preset.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace glidar {
namespace {

constexpr std::uint32_t kOther = 0;  ///< the sensor that sees all
constexpr std::uint32_t kOwn = 1;    ///< the sensor that does not see its own robot

/// A large box ahead along z and x, and a sphere before it.
Scene surroundings() {
  Scene scene = testing::scene_of(make_builtin_model("box"));
  scene.instances[0].scale = 2.0;
  scene.instances[0].world_from_object.translation() << 4.0, 0.0, 4.0;
  add_model(scene, make_builtin_model("sphere:radius=0.5"));
  scene.instances[1].world_from_object.translation() << 1.5, 0.0, 1.5;
  scene.class_names.emplace_back("object");
  for (Instance& instance : scene.instances) instance.class_id = 1;
  return scene;
}

/// The same with a robot around the sensor, which is the last object.
Scene with_robot() {
  Scene scene = surroundings();
  add_model(scene, make_builtin_model("box:size=0.8"));
  scene.instances[2].world_from_object.translation() << 0.3, 0.1, 0.3;
  scene.instances[2].class_id = 1;
  scene.instances[2].hidden_from = {kOwn};
  return scene;
}

Frame measure(const Scene& scene, const Sensor& sensor, std::uint32_t sensor_id,
              const Motion& motion, const std::string& renderer = "auto") {
  Frame frame;
  frame.sensor_id = sensor_id;
  Simulator(scene, sensor, {.kind = renderer, .threads = 2})
      .simulate(motion, {.boxes = true}, frame);
  return frame;
}

bool sees_robot(const Frame& frame) {
  const std::vector<std::uint32_t>& hit = frame.ground_truth.instance;
  return std::find(hit.begin(), hit.end(), 2U) != hit.end();
}

void expect_equal(const Frame& frame, const Frame& expected) {
  ASSERT_EQ(frame.range_m.size(), expected.range_m.size());
  EXPECT_EQ(frame.status, expected.status);
  EXPECT_EQ(frame.ground_truth.instance, expected.ground_truth.instance);
  for (std::size_t i = 0; i < frame.range_m.size(); ++i) {
    const bool is_equal = frame.range_m[i] == expected.range_m[i] ||
                          (std::isnan(frame.range_m[i]) && std::isnan(expected.range_m[i]));
    ASSERT_TRUE(is_equal) << i;
  }
}

Sensor small_camera() {
  Sensor sensor;
  sensor.optics = pinhole_from_fov(48, 32, 1.0);
  return sensor;
}

class Visibility : public ::testing::TestWithParam<std::string> {};

TEST_P(Visibility, AHiddenObjectIsAsIfItWereNotThere) {
  const Scene scene = with_robot();
  const Scene without = surroundings();
  const Sensor sensor = testing::preset(GetParam());
  const Frame frame = measure(scene, sensor, kOwn, static_motion(scene, Pose::Identity()));
  expect_equal(frame, measure(without, sensor, kOwn, static_motion(without, Pose::Identity())));
  EXPECT_EQ(frame.boxes.size(), 2U);
}

INSTANTIATE_TEST_SUITE_P(Sensors, Visibility,
                         ::testing::Values("VLP-16", "OS1", "Azure-Kinect-NFOV-2x2", "D405"),
                         testing::parameter_name<std::string>);

class VisibilityInRenderer : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    try {
      if (GetParam() == "opengl") const opengl::EglContext context({});
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
  }
};

TEST_P(VisibilityInRenderer, AHiddenObjectIsAsIfItWereNotThere) {
  const Scene scene = with_robot();
  const Scene without = surroundings();
  const Pose pose = look_at({0.0, 0.0, 0.0}, {1.0, 0.0, 1.0}, Eigen::Vector3d::UnitY());
  const auto measure_in = [&](const Scene& measured, std::uint32_t sensor_id) {
    return measure(measured, small_camera(), sensor_id, static_motion(measured, pose), GetParam());
  };
  const Frame other = measure_in(scene, kOther);
  EXPECT_TRUE(sees_robot(other));
  EXPECT_EQ(other.boxes.size(), 3U);
  expect_equal(measure_in(scene, kOwn), measure_in(without, kOwn));
}

INSTANTIATE_TEST_SUITE_P(All, VisibilityInRenderer, ::testing::ValuesIn(renderer_kinds()),
                         [](const auto& test) { return test.param; });

TEST(VisibilityOfSensors, HoldsWhileEverythingMoves) {
  const Scene scene = with_robot();
  const Scene without = surroundings();
  const auto motion_in = [](const Scene& moved) {
    Motion motion = static_motion(moved, Pose::Identity());
    motion.world_from_sensor = ConstantTwist{
        .pose = Pose::Identity(), .angular_rad_s = {0.1, 0.0, 0.3}, .linear_m_s = {0.5, 0.0, 0.1}};
    for (std::size_t i = 1; i < moved.instances.size(); ++i) {
      motion.world_from_instance[i] = ConstantTwist{.pose = moved.instances[i].world_from_object,
                                                    .angular_rad_s = {0.0, 1.0, 0.0},
                                                    .linear_m_s = {0.5, 0.0, 0.1}};
    }
    return motion;
  };
  const Sensor sensor = testing::noise_free_preset("VLP-16");
  EXPECT_TRUE(sees_robot(measure(scene, sensor, kOther, motion_in(scene))));
  expect_equal(measure(scene, sensor, kOwn, motion_in(scene)),
               measure(without, sensor, kOwn, motion_in(without)));
}

TEST(VisibilityOfSensors, SensorsOfABatchDiffer) {
  const Scene scene = with_robot();
  const Pose pose = look_at({0.0, 0.0, 0.0}, {1.0, 0.0, 1.0}, Eigen::Vector3d::UnitY());
  Simulator simulator(scene, small_camera(), RendererOptions{.threads = 2});
  std::vector<Frame> frames(3);
  for (std::uint32_t i = 0; i < 3; ++i) frames[i].sensor_id = i;
  simulator.simulate_batch(std::vector<Motion>(3, static_motion(scene, pose)), {}, frames);
  EXPECT_TRUE(sees_robot(frames[0]));
  EXPECT_FALSE(sees_robot(frames[1]));
  EXPECT_TRUE(sees_robot(frames[2]));
}

TEST(VisibilityOfSensors, VisibleToNamesTheOnlyOnes) {
  Instance instance;
  instance.visible_to = {2, 4};
  instance.hidden_from = {4};
  EXPECT_FALSE(is_visible(instance, 0));
  EXPECT_TRUE(is_visible(instance, 2));
  EXPECT_FALSE(is_visible(instance, 4));
  EXPECT_TRUE(is_visible(Instance{}, 7));
}

}  // namespace
}  // namespace glidar
