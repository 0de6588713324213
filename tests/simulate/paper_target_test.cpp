// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The picture of the 2016 paper against the truth that is attached to it.
#include <glidar/core/error.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <glidar/simulate/simulate.hpp>
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

/// A measurement through the paper's picture, and how far it is from the truth.
struct Measured {
  Frame frame;
  Frame exact;  ///< the same without the picture

  [[nodiscard]] double step_m() const {
    return (frame.picture.far_m - frame.picture.near_m) / 65536.0;
  }
};

class PaperTargetTest : public ::testing::Test {
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
    const Beams beams = make_beams(sensor);
    const Motion motion = static_motion(scene, pose);
    const auto renderer = make_renderer(scene, {.threads = 2});
    const auto camera = make_paper_camera(scene, {.kind = "opengl", .threads = 2});
    const HitFieldMask fields{.depth = true, .incidence = true};
    simulate(
        {.scene = scene, .sensor = sensor, .beams = beams, .motion = motion, .renderer = *renderer},
        fields, measured.exact);
    simulate({.scene = scene,
              .sensor = sensor,
              .beams = beams,
              .motion = motion,
              .renderer = *renderer,
              .progress = {},
              .paper = Woods2016Target{*camera, planes}},
             fields, measured.frame);
    return measured;
  }
};

Sensor camera(std::uint32_t width, std::uint32_t height, double fov_y_rad) {
  Sensor sensor;
  sensor.optics = pinhole_from_fov(width, height, fov_y_rad);
  return sensor;
}

/// Depth within half a step, intensity within one of 255, away from outlines: where a pixel's
/// neighbours see the same surface.
void expect_near_truth(const Measured& m, double most_other) {
  std::size_t compared = 0;
  std::size_t other = 0;
  const Frame& frame = m.frame;
  // The device interpolates depths in single precision: a little more than half a step.
  const double depth_tolerance = 0.52 * m.step_m();
  for (std::size_t i = 0; i < frame.range_m.size(); ++i) {
    if (frame.status[i] != m.exact.status[i]) {
      ++other;
      continue;
    }
    if (frame.status[i] != Status::hit) continue;
    ++compared;
    const double slope = frame.ground_truth.depth_m[i] / frame.ground_truth.range_m[i];
    const double depth_error = std::abs(frame.range_m[i] - m.exact.range_m[i]) * slope;
    const double light_error = std::abs(frame.intensity[i] - std::min(1.0F, m.exact.intensity[i]));
    if (depth_error > depth_tolerance || light_error > 1.0 / 255.0) ++other;
  }
  EXPECT_GT(compared, 5000U);
  EXPECT_LE(static_cast<double>(other), most_other * static_cast<double>(compared));
}

TEST_F(PaperTargetTest, DepthIsWithinHalfAStepAndLightWithinAByteOnASphere) {
  const Scene scene = builtin("sphere");
  const Pose pose = look_at({6.0, 1.0, 2.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const Measured m = measure(scene, camera(300, 200, 0.4), pose);
  expect_near_truth(m, 0.0005);
  EXPECT_LT(m.frame.picture.far_m - m.frame.picture.near_m, 2.0 + 1e-6);  // hugs it
}

TEST_F(PaperTargetTest, AndOnABumpyAsteroidWithColours) {
  const Scene scene = builtin("asteroid");
  const Pose pose = look_at({3.0, 1.0, 1.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  expect_near_truth(measure(scene, camera(300, 300, 0.7), pose), 0.001);
}

TEST_F(PaperTargetTest, AndFromTenKilometresWithAttenuation) {
  Scene scene = builtin("torus");
  scene.instances[0].world_from_object.translation() = Eigen::Vector3d(1e6, 2e6, -3e5);
  const Eigen::Vector3d middle = scene.instances[0].world_from_object.translation();
  const Pose pose = look_at(middle + Eigen::Vector3d(6e3, 0.0, 8e3), middle, {0.0, 1.0, 0.0});
  expect_near_truth(measure(scene, camera(200, 200, 3e-4), pose), 0.001);
}

TEST_F(PaperTargetTest, AndWithEveryTextureOfTheSatellite) {
  const Scene scene = testing::scene_of(
      load_model(std::string(kSourceFolder) + "/models/satellite/satellite.obj", {}, {}));
  const Eigen::AlignedBox3d box = bounds(scene);
  const double distance = 2.0 * box.diagonal().norm();
  const Eigen::Vector3d eye = box.center() + distance * Eigen::Vector3d(0.5, -0.7, 0.51);
  const Pose pose = look_at(eye, box.center(), Eigen::Vector3d::UnitZ());
  expect_near_truth(measure(scene, camera(400, 400, 0.4), pose), 0.01);
}

TEST_F(PaperTargetTest, ShowsShininessMasksNormalMapsAndFlatMeshes) {
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
  expect_near_truth(measure(scene, camera(200, 200, 0.7), pose), 0.01);
  mesh.normals.clear();
  expect_near_truth(measure(scene, camera(200, 200, 0.7), pose), 0.01);
}

TEST_F(PaperTargetTest, PlanesThatDoNotHugCostTheirStep) {
  const Scene scene = builtin("sphere");
  const Pose pose = look_at({6.0, 1.0, 2.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const Measured m = measure(scene, camera(300, 200, 0.4), pose, Woods2016DepthPlanes{1.0, 1001.0});
  EXPECT_EQ(m.frame.picture.far_m, 1001.0);
  EXPECT_TRUE(m.exact.picture.rgba.empty());
  expect_near_truth(m, 0.0005);  // of steps 500 times as large
}

TEST_F(PaperTargetTest, NothingInViewIsAllMisses) {
  const Scene scene = builtin("sphere");
  const Pose pose = look_at({6.0, 1.0, 2.0}, {9.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const Measured m = measure(scene, camera(20, 20, 0.4), pose);
  for (const Status status : m.frame.status) EXPECT_EQ(status, Status::miss);
}

TEST_F(PaperTargetTest, RefusesPulsedLightAndErrorsOfPointing) {
  const Scene scene = builtin("sphere");
  Sensor sensor = camera(20, 20, 0.4);
  sensor.pulse = LidarEquation{};
  const std::string allowed =
      "; allowed: the paper's light, and beams that fire together where they are aimed; "
      "leave --quantized-framebuffer out";
  EXPECT_EQ(error_text([&] { measure(scene, sensor, Pose::Identity()); }),
            "paper target: pulsed light" + allowed);
  sensor.pulse.reset();
  sensor.noise = {PointingJitter{1e-4, 1e-4}};
  EXPECT_EQ(error_text([&] { measure(scene, sensor, Pose::Identity()); }),
            "paper target: errors of pointing" + allowed);
}

}  // namespace
}  // namespace glidar
