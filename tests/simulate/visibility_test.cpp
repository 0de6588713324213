// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Objects that some sensors of a rig do not see.
#include <glidar/core/error.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/simulate/explain.hpp>
#include <glidar/simulate/simulator.hpp>
#include <simulate/scanner_stage.hpp>
#include <simulate/stereo_camera.hpp>
#include <simulate/tof_stage.hpp>
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
  EXPECT_EQ(frame.intensity, expected.intensity);
  EXPECT_EQ(frame.return_source, expected.return_source);
  EXPECT_EQ(frame.tof_images.level, expected.tof_images.level);
  EXPECT_EQ(frame.bounced_share, expected.bounced_share);
  ASSERT_EQ(frame.raw_images.size(), expected.raw_images.size());
  for (std::size_t i = 0; i < frame.raw_images.size(); ++i) {
    EXPECT_EQ(frame.raw_images[i].grey.level, expected.raw_images[i].grey.level) << i;
  }
  ASSERT_EQ(frame.boxes.size(), expected.boxes.size());
  for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
    EXPECT_EQ(frame.boxes[i].beams, expected.boxes[i].beams) << i;
    EXPECT_EQ(frame.boxes[i].visible_beams, expected.boxes[i].visible_beams) << i;
  }
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

/// A pulsed sensor whose beams are single rays.
Sensor single_rays() {
  Sensor sensor = small_camera();
  sensor.wavelength_m = 905e-9;
  sensor.lidar_equation = LidarEquation{};
  return sensor;
}

Sensor tof_camera() {
  testing::TofStage stage({100e6}, 4);
  stage.camera().bounces = 2;
  stage.camera().signal_electrons = 1e5;
  stage.sensor.optics = pinhole_from_fov(24, 16, 1.0);
  return stage.sensor;
}

/// A camera with a single imager, which compares its image with a stored one.
Sensor one_imager() {
  Sensor sensor = testing::stereo_sensor();
  testing::stereo_camera(sensor).reference = ActiveStereo::Reference::pattern;
  return sensor;
}

struct CameraCase {
  const char* name;
  Sensor (*make)();
};

void PrintTo(const CameraCase& camera, std::ostream* out) {
  *out << camera.name;
}

class VisibilityOfCamera : public ::testing::TestWithParam<CameraCase> {
 protected:
  static Motion motion_in(const Scene& scene) {
    const Eigen::Vector3d middle(1.0, 0.0, 1.0);
    return static_motion(scene, look_at({0.0, 0.0, 0.0}, middle, Eigen::Vector3d::UnitY()));
  }

  static Frame measure_in(const Scene& scene, std::uint32_t sensor_id) {
    return measure(scene, GetParam().make(), sensor_id, motion_in(scene));
  }
};

TEST_P(VisibilityOfCamera, HasNoImageShadowOrBounceOfAHiddenObject) {
  const Frame frame = measure_in(with_robot(), kOwn);
  expect_equal(frame, measure_in(surroundings(), kOwn));
  EXPECT_TRUE(std::any_of(frame.range_m.begin(), frame.range_m.end(),
                          [](double range_m) { return range_m > 1.0; }));
  EXPECT_TRUE(sees_robot(measure_in(with_robot(), kOther)));
}

TEST_P(VisibilityOfCamera, ExplainsAPointAsWithoutTheHiddenObject) {
  const Scene scene = with_robot();
  const Scene without = surroundings();
  const Frame known = measure_in(without, kOwn);
  const auto hit = std::find(known.status.begin(), known.status.end(), Status::hit);
  ASSERT_NE(hit, known.status.end());
  const auto entry = static_cast<std::size_t>(hit - known.status.begin());
  const auto trace_in = [entry](const Scene& explained) {
    Simulator simulator(explained, GetParam().make(), RendererOptions{.threads = 2});
    Frame frame;
    frame.sensor_id = kOwn;
    return explain(simulator, motion_in(explained), entry, frame);
  };
  const PointTrace trace = trace_in(scene);
  EXPECT_EQ(trace.reported.range_m, known.range_m[entry]);
  EXPECT_EQ(trace.measured.range_m, trace_in(without).measured.range_m);
}

INSTANTIATE_TEST_SUITE_P(
    All, VisibilityOfCamera,
    ::testing::Values(CameraCase{"structured_light", [] { return testing::ScannerStage().sensor; }},
                      CameraCase{"stereo", [] { return testing::stereo_sensor(); }},
                      CameraCase{"one_imager", one_imager},
                      CameraCase{"time_of_flight", tof_camera}, CameraCase{"pulses", single_rays}),
    [](const auto& test) { return std::string(test.param.name); });

/// Its large box is a mirror.
Scene mirrored(Scene scene) {
  for (const std::uint32_t i : scene.instances[0].materials) {
    scene.materials[i].mirror = 0.9F;
    scene.materials[i].diffuse.setZero();
  }
  return scene;
}

std::ptrdiff_t count_ghosts(const Frame& frame) {
  return std::count(frame.return_source.begin(), frame.return_source.end(), ReturnSource::ghost);
}

TEST(VisibilityOfMirrors, AMirrorShowsAHiddenObjectToOtherSensorsOnly) {
  Scene scene = mirrored(with_robot());
  // below the field of view; beams get there from the lower side of the box
  scene.instances[2].world_from_object.translation() << 11.0, 0.0, -1.5;
  scene.instances[2].scale = 4.0;
  const Scene without = mirrored(surroundings());
  const Pose pose = look_at({0.0, 0.0, 0.0}, {1.0, 0.0, 1.0}, Eigen::Vector3d::UnitY());
  const auto measure_in = [&](const Scene& measured, std::uint32_t sensor_id) {
    return measure(measured, single_rays(), sensor_id, static_motion(measured, pose));
  };
  const Frame own = measure_in(scene, kOwn);
  expect_equal(own, measure_in(without, kOwn));
  const Frame other = measure_in(scene, kOther);
  EXPECT_FALSE(sees_robot(other));
  EXPECT_GT(count_ghosts(other), count_ghosts(own));
}

TEST(VisibilityOfMirrors, AHiddenMirrorChangesNoBit) {
  Scene scene = with_robot();
  for (const std::uint32_t i : scene.instances[2].materials) scene.materials[i].mirror = 0.9F;
  const Scene without = surroundings();
  const Pose pose = look_at({0.0, 0.0, 0.0}, {1.0, 0.0, 1.0}, Eigen::Vector3d::UnitY());
  for (const Sensor& sensor : {single_rays(), testing::preset("VLP-16")}) {
    expect_equal(measure(scene, sensor, kOwn, static_motion(scene, pose)),
                 measure(without, sensor, kOwn, static_motion(without, pose)));
  }
}

class VisibilityInRenderer : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    try {
      if (GetParam() == "gpu") make_renderer(Scene(), {.kind = "gpu"});
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
