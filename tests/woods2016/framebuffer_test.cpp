// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The quantised framebuffer of the 2016 paper against the measurement from ray casting.
#include <glidar/core/error.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <glidar/simulate/simulator.hpp>
#include <glidar/woods2016/framebuffer.hpp>
#include <support/data.hpp>
#include <support/error_text.hpp>
#include <support/source_folder.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

Scene builtin(const char* name) {
  Scene scene;
  add_model(scene, make_builtin_model(name));
  return scene;
}

/// One scene, measured with the framebuffer and without.
struct Measured {
  Frame frame;  ///< decoded from the framebuffer
  Frame exact;  ///< from the renderer's hits

  [[nodiscard]] double step_m() const {
    return (frame.framebuffer.far_m - frame.framebuffer.near_m) / 65536.0;
  }
};

class Woods2016Measurement : public ::testing::Test {
 protected:
  void SetUp() override {
    try {
      const opengl::EglContext context({});
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
  }

  static Measured measure(const Scene& scene, const Sensor& sensor, const Pose& pose,
                          std::optional<Woods2016DepthPlanes> planes = {}) {
    Measured measured;
    const Motion motion = static_motion(scene, pose);
    const auto camera = make_woods2016_camera(scene, {.kind = "opengl", .threads = 2});
    const HitColumnMask hit_columns{.depth = true, .incidence = true};
    Simulator simulator(scene, sensor, {.threads = 2});
    simulator.simulate(motion, hit_columns, measured.exact);
    simulator.set_return_replacement(woods2016_measurement(*camera, planes));
    simulator.simulate(motion, hit_columns, measured.frame);
    return measured;
  }
};

Sensor camera(std::uint32_t width, std::uint32_t height, double fov_y_rad) {
  Sensor sensor;
  sensor.optics = pinhole_from_fov(width, height, fov_y_rad);
  return sensor;
}

/// Expects depths within half a step and intensities within 1/255. At most the share
/// `max_outliers` of the pixels may differ, because silhouettes are rasterized differently.
void expect_near_exact(const Measured& m, double max_outliers) {
  std::size_t compared = 0;
  std::size_t outliers = 0;
  const Frame& frame = m.frame;
  // Half a step, and the rounding of depths that the GPU interpolates in single precision.
  const double depth_tolerance = 0.52 * m.step_m();
  for (std::size_t i = 0; i < frame.range_m.size(); ++i) {
    if (frame.status[i] != m.exact.status[i]) {
      ++outliers;
      continue;
    }
    if (frame.status[i] != Status::hit) continue;
    ++compared;
    const double slope = frame.ground_truth.depth_m[i] / frame.ground_truth.range_m[i];
    const double depth_error = std::abs(frame.range_m[i] - m.exact.range_m[i]) * slope;
    const double light_error = std::abs(frame.intensity[i] - std::min(1.0F, m.exact.intensity[i]));
    if (depth_error > depth_tolerance || light_error > 1.0 / 255.0) ++outliers;
  }
  EXPECT_GT(compared, 5000U);
  EXPECT_LE(static_cast<double>(outliers), max_outliers * static_cast<double>(compared));
}

TEST_F(Woods2016Measurement, IsWithinHalfADepthStepAndOneIntensityStepOnASphere) {
  const Scene scene = builtin("sphere");
  const Pose pose = look_at({6.0, 1.0, 2.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const Measured m = measure(scene, camera(300, 200, 0.4), pose);
  expect_near_exact(m, 0.0005);
  EXPECT_LT(m.frame.framebuffer.far_m - m.frame.framebuffer.near_m,
            2.0 + 1e-6);  // tight around the sphere
}

TEST_F(Woods2016Measurement, IsAsExactOnAColouredAsteroid) {
  const Scene scene = builtin("asteroid");
  const Pose pose = look_at({3.0, 1.0, 1.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  expect_near_exact(measure(scene, camera(300, 300, 0.7), pose), 0.001);
}

TEST_F(Woods2016Measurement, IsAsExactAtTenKilometresWithAttenuation) {
  Scene scene = builtin("torus");
  scene.instances[0].world_from_object.translation() = Eigen::Vector3d(1e6, 2e6, -3e5);
  const Eigen::Vector3d middle = scene.instances[0].world_from_object.translation();
  const Pose pose = look_at(middle + Eigen::Vector3d(6e3, 0.0, 8e3), middle, {0.0, 1.0, 0.0});
  expect_near_exact(measure(scene, camera(200, 200, 3e-4), pose), 0.001);
}

TEST_F(Woods2016Measurement, IsAsExactWithTheTexturesOfTheSatellite) {
  const Scene scene = testing::scene_of(
      load_model(std::string(kSourceFolder) + "/models/satellite/satellite.obj", {}, {}));
  const Eigen::AlignedBox3d box = bounds(scene);
  const double distance = 2.0 * box.diagonal().norm();
  const Eigen::Vector3d eye = box.center() + distance * Eigen::Vector3d(0.5, -0.7, 0.51);
  const Pose pose = look_at(eye, box.center(), Eigen::Vector3d::UnitZ());
  expect_near_exact(measure(scene, camera(400, 400, 0.4), pose), 0.01);
}

TEST_F(Woods2016Measurement, IsAsExactWithShininessMasksNormalMapsAndFlatMeshes) {
  Scene scene = builtin("plane");
  Material& material = scene.materials[scene.instances[0].materials[0]];
  scene.textures.push_back(
      {.name = "rgba",
       .width = 2,
       .height = 2,
       .channels = 4,
       .texels = {250, 10, 90, 255, 80, 90, 60, 20, 128, 128, 255, 200, 190, 60, 220, 140}});
  material.diffuse_texture = {.texture = 0, .wrap_u = Wrap::mirror};
  material.diffuse_texture.uv_scale_rotate << 3.0F, 1.0F, -2.0F, 4.0F;
  material.specular = {0.2F, 0.4F, 0.1F};
  material.shininess = 12.5F;
  material.specular_texture = {.texture = 0, .filter = Filter::nearest};
  material.normal_texture = {.texture = 0, .wrap_v = Wrap::clamp};
  material.alpha_texture = {.texture = 0};
  material.alpha_cutoff = 0.3F;
  Mesh& mesh = scene.meshes[0];
  mesh.tangents.assign(mesh.positions_m.size(), Eigen::Vector4f(1.0F, 0.0F, 0.0F, -1.0F));
  const Pose pose = look_at({0.6, -0.8, 2.5}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitY());
  expect_near_exact(measure(scene, camera(200, 200, 0.7), pose), 0.01);
  mesh.normals.clear();
  expect_near_exact(measure(scene, camera(200, 200, 0.7), pose), 0.01);
}

TEST_F(Woods2016Measurement, GivenPlanesSetTheDepthStep) {
  const Scene scene = builtin("sphere");
  const Pose pose = look_at({6.0, 1.0, 2.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const Measured m = measure(scene, camera(300, 200, 0.4), pose, Woods2016DepthPlanes{1.0, 1001.0});
  EXPECT_EQ(m.frame.framebuffer.far_m, 1001.0);
  EXPECT_TRUE(m.exact.framebuffer.rgba.empty());
  expect_near_exact(m, 0.0005);  // the step is 500 times as large
}

TEST_F(Woods2016Measurement, AnEmptyViewGivesOnlyMisses) {
  const Scene scene = builtin("sphere");
  const Pose pose = look_at({6.0, 1.0, 2.0}, {9.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const Measured m = measure(scene, camera(20, 20, 0.4), pose);
  for (const Status status : m.frame.status) EXPECT_EQ(status, Status::miss);
}

TEST_F(Woods2016Measurement, RejectsPulsedSensorsAndPointingNoise) {
  const Scene scene = builtin("sphere");
  Sensor sensor = camera(20, 20, 0.4);
  sensor.lidar_equation = LidarEquation{};
  const std::string allowed =
      "; allowed: sensors without lidar_equation, firing times and pointing noise; "
      "leave --quantized-framebuffer out";
  EXPECT_EQ(error_text([&] { measure(scene, sensor, Pose::Identity()); }),
            "--quantized-framebuffer: a pulsed sensor" + allowed);
  sensor.lidar_equation.reset();
  sensor.noise = {PointingJitter{1e-4, 1e-4}};
  EXPECT_EQ(error_text([&] { measure(scene, sensor, Pose::Identity()); }),
            "--quantized-framebuffer: pointing noise" + allowed);
}

TEST(Woods2016Framebuffer, DecodesToTheMiddleOfAStepAndDividesByTheCosine) {
  Woods2016Framebuffer framebuffer{
      .rows = 1, .cols = 3, .near_m = 10.0, .far_m = 75.536, .rgba = {}};
  framebuffer.rgba = {0, 0, 0, 0, 51, 1, 2, 255, 255, 255, 255, 255};
  const Beams beams = make_beams(
      Pinhole{{.width = 3, .height = 1, .fx = 1.0, .fy = 1.0, .cx = 1.5, .cy = 0.5}, {}});
  std::vector<double> range_m(3);
  std::vector<float> intensity(3);
  decode_framebuffer(framebuffer, beams, {0, 3}, range_m, intensity);
  EXPECT_TRUE(std::isnan(range_m[0]));
  EXPECT_EQ(intensity[0], 0.0F);
  EXPECT_DOUBLE_EQ(range_m[1], 10.2585);  // step 256 + 2 of 1 mm
  EXPECT_FLOAT_EQ(intensity[1], 0.2F);
  EXPECT_DOUBLE_EQ(range_m[2], 75.5355 * std::sqrt(2.0));
  EXPECT_EQ(intensity[2], 1.0F);
}

}  // namespace
}  // namespace glidar
