// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <simulate/stereo_camera.hpp>
#include <support/error_text.hpp>

#include <glidar/sensor/lidar/lidar_equation.hpp>

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace glidar {
namespace {

using testing::image_of;
using testing::kStereoBaseline_m;
using testing::kStereoFocal_px;
using testing::PanelScene;
using testing::shoot;
using testing::stereo_camera;
using testing::stereo_sensor;
using testing::use_even_light;

constexpr std::uint32_t kWidth = 64;
constexpr std::uint32_t kHeight = 48;

Sensor small_sensor() {
  Sensor sensor = stereo_sensor(kWidth, kHeight);
  stereo_camera(sensor).matcher.disparities = 32;
  return sensor;
}

Sensor evenly_lit_sensor() {
  Sensor sensor = small_sensor();
  use_even_light(sensor);
  return sensor;
}

/// Electrons that a pixel receives of a radiance, by the camera equation.
double electrons_of(const Sensor& sensor, double radiance, const Eigen::Vector3d& direction) {
  const auto& camera = std::get<ActiveStereo>(*sensor.depth_camera);
  const double rate =
      electron_rate_per_radiance(camera.imager, kStereoFocal_px, sensor.wavelength_m);
  return radiance * rate * std::pow(direction.z(), 4) * camera.imager.exposure_s;
}

/// Of the even projector.
double even_intensity(const ActiveStereo& camera) {
  const double a = std::tan(0.5 * camera.projector.fov_x_rad);
  return camera.projector.power_w / (4.0 * std::atan(a * a / std::sqrt(1.0 + 2.0 * a * a)));
}

// E = I cos(t) / r², L = rho E / pi, for a wall and a projector beside the camera.
TEST(InfraredImage, OfAWallFollowsTheFormulaOfItsLight) {
  const Sensor sensor = evenly_lit_sensor();
  const auto& camera = std::get<ActiveStereo>(*sensor.depth_camera);
  const Beams beams = make_beams(sensor);
  for (const double z_m : {0.5, 2.0}) {
    PanelScene panels;
    panels.add_wall(z_m).diffuse.setConstant(0.4F);
    const Frame frame = shoot(panels.scene, sensor);
    for (const char* name : {"ir_left", "ir_right"}) {
      const double eye_m = name == std::string("ir_left") ? 0.0 : kStereoBaseline_m;
      for (const std::size_t i : {std::size_t{10 * kWidth + 15}, std::size_t{24 * kWidth + 32},
                                  std::size_t{38 * kWidth + 50}}) {
        const Eigen::Vector3d direction = beams.directions[i];
        const Eigen::Vector3d point =
            direction * (z_m / direction.z()) + Eigen::Vector3d(eye_m, 0.0, 0.0);
        const Eigen::Vector3d path = point - camera.projector.origin_m;
        const double cosine = path.z() / path.norm();
        const double radiance =
            0.4 * std::numbers::inv_pi * even_intensity(camera) * cosine / path.squaredNorm();
        const double expected = electrons_of(sensor, radiance, direction);
        EXPECT_NEAR(image_of(frame, name).electrons[i], expected, 1e-3 * expected)
            << name << ' ' << i << ' ' << z_m;
      }
    }
  }
}

TEST(InfraredImage, OfSunAndAmbientLightFollowsTheFormula) {
  Sensor sensor = evenly_lit_sensor();
  ActiveStereo& camera = stereo_camera(sensor);
  camera.projector.power_w = 0.0;
  camera.illumination = {.ambient_w_per_m2 = 0.3, .sun_w_per_m2 = 2.0, .sun_direction = {0, 3, -4}};
  PanelScene panels;
  panels.add_wall(1.0).diffuse.setConstant(0.5F);
  const Frame frame = shoot(panels.scene, sensor);
  const std::size_t middle = 24 * kWidth + 32;
  const double radiance = 0.5 * std::numbers::inv_pi * (0.3 + 2.0 * 0.8);
  const double expected = electrons_of(sensor, radiance, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(image_of(frame, "ir_left").electrons[middle], expected, 1e-3 * expected);
  camera.illumination.sun_direction = {0, 3, 4};  // behind the wall
  const Frame averted = shoot(panels.scene, sensor);
  EXPECT_NEAR(image_of(averted, "ir_left").electrons[middle], expected * 0.3 / 1.9,
              1e-3 * expected);
}

TEST(InfraredImage, OfNoSurfaceShowsTheSurroundings) {
  Sensor sensor = evenly_lit_sensor();
  stereo_camera(sensor).illumination.ambient_w_per_m2 = 0.3;
  PanelScene panels;
  panels.add_wall(-1.0);  // behind the camera
  const Frame frame = shoot(panels.scene, sensor);
  const double expected =
      electrons_of(sensor, 0.3 * std::numbers::inv_pi, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(image_of(frame, "ir_left").electrons[24 * kWidth + 32], expected, 1e-3 * expected);
}

// With projector and camera in one place a surface has its monostatic backscatter.
TEST(InfraredImage, HasTheBackscatterOfSurfaces) {
  Sensor sensor = evenly_lit_sensor();
  ActiveStereo& camera = stereo_camera(sensor);
  camera.projector.origin_m.setZero();
  const Brdf kSurfaces[] = {Lambert{}, PhongLike{0.4, 30.0}, OrenNayar{0.5}, RetroReflector{9.0},
                            Glossy{0.05, 2.0, 0.3}};
  for (const Brdf& brdf : kSurfaces) {
    PanelScene panels;  // seen at 30 degrees from its normal on the axis
    Material& material =
        panels.add_panel({-5.0, -5.0, 1.0 - 5.0 * std::tan(30.0 * kDegree)},
                         {10.0, 0.0, 10.0 * std::tan(30.0 * kDegree)}, {0.0, 10.0, 0.0});
    material.diffuse.setConstant(0.6F);
    material.backscatter = brdf;
    const double cosine = std::cos(30.0 * kDegree);
    const double radiance =
        backscatter(brdf, 0.6, cosine) * even_intensity(camera) * std::numbers::inv_pi;
    const double expected = electrons_of(sensor, radiance, Eigen::Vector3d::UnitZ());
    const Frame frame = shoot(panels.scene, sensor);
    double sum = 0.0;  // of the pixels around the axis
    for (const std::size_t i :
         {23 * kWidth + 31, 23 * kWidth + 32, 24 * kWidth + 31, 24 * kWidth + 32}) {
      sum += image_of(frame, "ir_left").electrons[i];
    }
    EXPECT_NEAR(0.25 * sum, expected, 2e-3 * expected) << brdf.index();
  }
}

TEST(InfraredImage, LosesTheLightThatASurfaceLetsPass) {
  const Sensor sensor = evenly_lit_sensor();
  PanelScene solid;
  solid.add_wall(1.0);
  PanelScene glass;
  glass.add_wall(1.0).opacity = 0.25F;
  const std::size_t middle = 24 * kWidth + 32;
  const float through_glass = image_of(shoot(glass.scene, sensor), "ir_left").electrons[middle];
  EXPECT_NEAR(through_glass,
              0.25F * image_of(shoot(solid.scene, sensor), "ir_left").electrons[middle],
              1e-5F * through_glass);
}

/// The centroid of an image, in columns and rows from the upper left corner.
Eigen::Vector2d centroid_of(const std::vector<float>& electrons) {
  double sum = 0.0;
  Eigen::Vector2d weighted = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < electrons.size(); ++i) {
    const Eigen::Vector2d centre(static_cast<double>(i % kWidth) + 0.5,
                                 static_cast<double>(i / kWidth) + 0.5);
    weighted += electrons[i] * centre;
    sum += electrons[i];
  }
  return weighted / sum;
}

// A dot at (x, y) of the plane z = 1 before the projector is at p + z (x, y, 1) on a wall.
TEST(InfraredImage, ShowsDotsWhereTheProjectionPutsThem) {
  Sensor sensor = evenly_lit_sensor();
  ActiveStereo& camera = stereo_camera(sensor);
  camera.projector.pattern = {};
  camera.projector.fov_x_rad = 4.0 * kDegree;
  camera.projector.fov_y_rad = 4.0 * kDegree;
  camera.projector.dots = 1;
  camera.sub_rays = 5;
  const Eigen::Vector2d dot = place_dots(camera.projector).front().centre;
  for (const double z_m : {0.83, 1.7}) {
    PanelScene panels;
    panels.add_wall(z_m);
    const Frame frame = shoot(panels.scene, sensor);
    for (const char* name : {"ir_left", "ir_right"}) {
      const double eye_m = name == std::string("ir_left") ? 0.0 : kStereoBaseline_m;
      const double x = dot.x() + (camera.projector.origin_m.x() - eye_m) / z_m;
      const Eigen::Vector2d expected = kStereoFocal_px * Eigen::Vector2d(x, dot.y()) +
                                       Eigen::Vector2d(0.5 * kWidth, 0.5 * kHeight);
      const Eigen::Vector2d found = centroid_of(image_of(frame, name).electrons);
      EXPECT_NEAR(found.x(), expected.x(), 0.01) << name << ' ' << z_m;
      EXPECT_NEAR(found.y(), expected.y(), 0.01) << name << ' ' << z_m;
    }
  }
}

// The left image's shadow is f p (1/z1 - 1/z2) wide, p the projector's distance from the camera.
TEST(InfraredImage, HasShadowsOfTheProjectorOfTheirWidth) {
  Sensor sensor = evenly_lit_sensor();
  stereo_camera(sensor).imager.blur_px = 0.0;
  for (const std::uint32_t sub_rays : {1U, 2U, 3U}) {
    stereo_camera(sensor).sub_rays = sub_rays;
    PanelScene panels;
    panels.add_wall(0.5, 0.0, 5.0);
    panels.add_wall(1.0);
    const Frame frame = shoot(panels.scene, sensor);
    double dark = 0.0;
    for (std::size_t column = 0; column < kWidth / 2; ++column) {
      const std::size_t row = 24 * std::size_t{kWidth};
      const float lit = image_of(frame, "ir_left").electrons[row + 2];
      dark += 1.0 - image_of(frame, "ir_left").electrons[row + column] / lit;
    }
    EXPECT_NEAR(dark, kStereoFocal_px * 0.029 * (2.0 - 1.0), 1.0 / sub_rays + 0.02) << sub_rays;
  }
}

TEST(InfraredImage, HasShadowsOfTheSun) {
  Sensor sensor = evenly_lit_sensor();
  ActiveStereo& camera = stereo_camera(sensor);
  camera.projector.power_w = 0.0;
  camera.imager.blur_px = 0.0;
  camera.illumination.sun_w_per_m2 = 1.0;
  camera.illumination.sun_direction = {-1, 0, -1};
  PanelScene panels;
  panels.add_wall(1.0);
  panels.add_panel({-0.02, -1.0, 0.95}, {0.01, 0.0, 0.0}, {0.0, 2.0, 0.0});
  const Frame frame = shoot(panels.scene, sensor);
  const auto at = [&](double x) {  // on the wall
    const auto column = static_cast<std::size_t>(0.5 * kWidth + kStereoFocal_px * x);
    return image_of(frame, "ir_left").electrons[24 * std::size_t{kWidth} + column];
  };
  EXPECT_EQ(at(0.035), 0.0F) << "the shadow is from 0.03 to 0.04 m";
  EXPECT_GT(at(0.055), 0.0F);
  EXPECT_GT(at(0.015), 0.0F);
}

TEST(InfraredImage, IsTheSameForAnyThreadsAndRenderers) {
  const Sensor sensor = small_sensor();
  PanelScene panels;
  panels.add_wall(0.7, 0.01, 5.0);
  panels.add_wall(1.3);
  const Frame expected = shoot(panels.scene, sensor, {.kind = "rays", .threads = 1});
  for (const RendererOptions& options : {RendererOptions{.kind = "rays", .threads = 2},
                                         RendererOptions{.kind = "rays", .threads = 8},
                                         RendererOptions{.kind = "auto", .threads = 2}}) {
    const Frame frame = shoot(panels.scene, sensor, options);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(frame.raw_images[k].grey.level, expected.raw_images[k].grey.level)
          << options.kind << ' ' << options.threads;
      EXPECT_EQ(frame.raw_images[k].electrons, expected.raw_images[k].electrons) << options.kind;
    }
    EXPECT_EQ(frame.status, expected.status) << options.kind;
    EXPECT_EQ(frame.range_m.size(), expected.range_m.size());
  }
}

// Rays from the projector have origins of their own, which need rays.
TEST(InfraredImage, IsRefusedByRenderersWithoutRays) {
  PanelScene panels;
  panels.add_wall(1.3);
  EXPECT_THAT(error_text([&] { shoot(panels.scene, small_sensor(), {.kind = "raster"}); }),
              ::testing::HasSubstr("use --renderer rays"));
}

/// The correlation of the noise of two images with the same electrons.
double noise_correlation(const RawImage& a, const RawImage& b, double levels_per_e) {
  double product = 0.0;
  double square_a = 0.0;
  double square_b = 0.0;
  for (std::size_t i = 0; i < a.electrons.size(); ++i) {
    const double x = a.grey.level[i] - levels_per_e * a.electrons[i];
    const double y = b.grey.level[i] - levels_per_e * b.electrons[i];
    product += x * y;
    square_a += x * x;
    square_b += y * y;
  }
  return product / std::sqrt(square_a * square_b);
}

// 3072 pixels: a standard error of 0.018.
TEST(InfraredImage, HasIndependentNoiseInEachImageAndFrame) {
  Sensor sensor = evenly_lit_sensor();
  ActiveStereo& camera = stereo_camera(sensor);
  camera.imager.bits = 16;
  const double levels = levels_per_electron(camera.imager, {.time_s = 0.01, .gain = 1.0});
  PanelScene panels;
  panels.add_wall(1.0);
  const Frame first = shoot(panels.scene, sensor, {}, 1);
  const Frame second = shoot(panels.scene, sensor, {}, 2);
  const RawImage& left = image_of(first, "ir_left");
  EXPECT_NEAR(noise_correlation(left, image_of(first, "ir_right"), levels), 0.0, 0.08);
  EXPECT_NEAR(noise_correlation(left, image_of(second, "ir_left"), levels), 0.0, 0.08);
  EXPECT_EQ(image_of(shoot(panels.scene, sensor, {}, 1), "ir_left").grey.level, left.grey.level);
}

}  // namespace
}  // namespace glidar
