// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/sensor/lidar/lidar_equation.hpp>
#include <simulate/scanner_stage.hpp>
#include <support/data.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

namespace glidar {
namespace {

using testing::count_of;
using testing::depth_error_m;
using testing::is_at_border;
using testing::kMaxRoundingError_rad;
using testing::kScannerBaseline_m;
using testing::kScannerFocal_px;
using testing::ScannerStage;
using testing::stage_coordinate_px;

/// Further errors of coordinates: interpolation between the projector's pixels (1e-4 rad at 32 px),
/// light that is not even within a pixel (1.3e-3 per pixel times the variance 0.33), and float.
constexpr double kMaxCoordinateError_px = 0.002;

double depth_of(const Frame& frame, const Beams& beams, std::size_t i) {
  return frame.range_m[i] * beams.directions[i].z();
}

double depth_tolerance_m(double z_m, double period_px) {
  return depth_error_m(z_m, period_px,
                       kMaxRoundingError_rad + kTwoPi / period_px * kMaxCoordinateError_px);
}

TEST(StructuredLightCameras, WithoutNoiseFindTheDepthOfAPlane) {
  for (const std::uint32_t steps : {3U, 4U, 8U}) {
    for (const bool has_inverses : {true, false}) {
      ScannerStage stage;
      stage.camera().patterns.steps = steps;
      stage.camera().patterns.has_inverses = has_inverses;
      stage.panels.add_wall(0.8);
      const Frame frame = stage.shoot();
      const Beams beams = make_beams(stage.sensor);
      EXPECT_EQ(frame.raw_images.size(), steps + (has_inverses ? 12U : 6U));
      for (std::size_t i = 0; i < beams.size(); ++i) {
        ASSERT_EQ(frame.status[i], Status::hit) << i << ' ' << steps << has_inverses;
        if (is_at_border(frame, i)) continue;
        EXPECT_NEAR(depth_of(frame, beams, i), 0.8, depth_tolerance_m(0.8, 32.0)) << i;
        EXPECT_NEAR(frame.projector_px[i],
                    stage_coordinate_px(0.8 / beams.directions[i].z() * beams.directions[i]),
                    32.0 / kTwoPi * kMaxRoundingError_rad + kMaxCoordinateError_px);
      }
    }
  }
}

TEST(StructuredLightCameras, FindTheSameDepthsByRowsAndThroughLenses) {
  ScannerStage stage(48, 48);
  stage.camera().patterns.axis = FringeAxis::rows;
  stage.camera().projector_from_camera.translation() = Eigen::Vector3d(0.0, -0.2, 0.0);
  stage.camera().projector.intrinsics.cx = 320.0;
  stage.camera().projector.intrinsics.cy = 310.0;
  stage.camera().projector.distortion = RadialTangential{.k1 = 0.02};
  std::get<Pinhole>(stage.sensor.optics).distortion = RadialTangential{.k1 = -0.1, .k2 = 0.02};
  stage.panels.add_wall(0.8);
  const Frame frame = stage.shoot();
  const Beams beams = make_beams(stage.sensor);
  EXPECT_EQ(count_of(frame, Status::hit), beams.size());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (is_at_border(frame, i)) continue;
    // The lens of the projector magnifies by up to 1 + 3 k1 r^2, by which tolerances shrink.
    EXPECT_NEAR(depth_of(frame, beams, i), 0.8, depth_tolerance_m(0.8, 32.0)) << i;
  }
}

// Stripes of 8 px have the coordinate of their middle. Between two of them a bit is not certain.
TEST(StructuredLightCameras, WithoutFringesFindTheStripesOfTheCode) {
  constexpr double kMaxDisplacement_px = 1.0;  // of the border between stripes, by blur
  ScannerStage stage;
  stage.camera().patterns.steps = 0;
  stage.camera().patterns.period_px = 16.0;
  stage.panels.add_wall(0.8);
  const Frame frame = stage.shoot();
  const Beams beams = make_beams(stage.sensor);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (frame.status[i] == Status::weak_code || is_at_border(frame, i)) continue;
    ASSERT_EQ(frame.status[i], Status::hit);
    EXPECT_NEAR(frame.projector_px[i],
                stage_coordinate_px(0.8 / beams.directions[i].z() * beams.directions[i]),
                4.0 + kMaxDisplacement_px);
  }
  EXPECT_GT(count_of(frame, Status::hit), 3 * beams.size() / 4);
}

// Within a pixel the surface bends by z'' / 2 and the light changes along its slope, both times the
// variance 0.33 px^2: 4e-5 and 1.2e-4 m at 60 degrees, which are 74 degrees for the projector, for
// pixels of 1.7 mm and a radius of 0.1 m.
TEST(StructuredLightCameras, WithoutNoiseFindTheDepthOfASphere) {
  constexpr double kMaxBend_m = 1.6e-4;
  ScannerStage stage(160, 120);
  stage.panels.scene = testing::scene_of(make_builtin_model("sphere:radius=0.1"));
  stage.world_from_sensor.translation() = Eigen::Vector3d(0.0, 0.0, -0.9);
  const Frame frame = stage.shoot();
  const Beams beams = make_beams(stage.sensor);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (frame.status[i] != Status::hit) continue;
    const bool is_surface = frame.ground_truth.instance[i] != kInvalidId;
    EXPECT_EQ(frame.return_source[i],
              is_surface ? ReturnSource::surface : ReturnSource::mixed_pixel);
    if (!is_surface || frame.ground_truth.cos_shading[i] < 0.5F) continue;
    EXPECT_NEAR(depth_of(frame, beams, i), double{frame.ground_truth.depth_m[i]},
                depth_tolerance_m(0.9, 32.0) + kMaxBend_m)
        << i;
    ++compared;
  }
  EXPECT_GT(compared, 5000U);  // of a disc of 55 px less its shadow
  EXPECT_GT(count_of(frame, Status::projector_shadow), 50U);
  EXPECT_GT(count_of(frame, Status::miss), 5000U);
}

// E = I cos(t) / r^2 times the pattern, L = rho E / pi, and the camera equation.
TEST(StructuredLightCameras, ExposeTheLightOfEachPattern) {
  ScannerStage stage;
  StructuredLightCamera& camera = stage.camera();
  camera.imager.exposure_s = 1.0;
  camera.imager.blur_px = 0.0;
  camera.illumination.ambient_w_per_m2 = 0.3;
  stage.panels.add_wall(0.8).diffuse.setConstant(0.4F);
  const Frame frame = stage.shoot();
  const Beams beams = make_beams(stage.sensor);
  const double white = white_intensity_w_per_sr(camera.projector, camera.light.power_w);
  const double rate =
      electron_rate_per_radiance(camera.imager, kScannerFocal_px, stage.sensor.wavelength_m);
  for (const std::size_t i : {std::size_t{5 * 160 + 20}, std::size_t{12 * 160 + 80}}) {
    const Eigen::Vector3d point = 0.8 / beams.directions[i].z() * beams.directions[i];
    const Eigen::Vector3d path = point - Eigen::Vector3d(kScannerBaseline_m, 0.0, 0.0);
    const double full = white * path.z() / std::pow(path.norm(), 3);
    for (std::size_t k = 0; k < frame.raw_images.size(); ++k) {
      const double x = stage_coordinate_px(point);
      if (k >= camera.patterns.steps && std::abs(std::remainder(x + 0.5, 16.0)) < 4.0) continue;
      const double share =
          k < camera.patterns.steps
              ? 0.5 + 0.5 * std::cos(kTwoPi * ((x + 0.5) / 32.0 - 0.25 * static_cast<double>(k)))
              : fringe_light(camera.patterns, k, static_cast<std::uint32_t>(std::lround(x)));
      const double radiance = 0.4 * std::numbers::inv_pi * (share * full + 0.3);
      const double electrons = radiance * rate * std::pow(beams.directions[i].z(), 4);
      // blur and interpolation take 1.5 % of the contrast of fringes of 32 px
      const double tolerance = 0.4 * std::numbers::inv_pi * rate * full * 0.01;
      EXPECT_NEAR(double{frame.raw_images[k].electrons[i]}, electrons, tolerance) << i << ' ' << k;
    }
  }
}

/// Mean and amplitude of the fringes of a pixel, electrons without noise.
struct FringeLight {
  double mean_e = 0.0;
  double amplitude_e = 0.0;
};

FringeLight fringe_light_of(const Frame& frame, std::uint32_t steps, std::size_t i) {
  double mean = 0.0;
  double sine = 0.0;
  double cosine = 0.0;
  for (std::uint32_t k = 0; k < steps; ++k) {
    const double electrons = frame.raw_images[k].electrons[i];
    mean += electrons / steps;
    sine += electrons * std::sin(kTwoPi * k / steps);
    cosine += electrons * std::cos(kTwoPi * k / steps);
  }
  return {mean, 2.0 / steps * std::hypot(sine, cosine)};
}

// s = sqrt(2/N) sigma_I / B and sigma_z = z^2 / (f b) T s / (2 pi), where sigma_I^2 is the mean of
// the fringes in electrons, read noise, and the rounding of levels. For steps other than 3 the
// variance of shot noise averages over the images. 7,680 differences: a standard error of 0.8 %.
TEST(StructuredLightCameras, HaveTheDepthNoiseOfTheirPhotons) {
  constexpr double kTolerance = 0.04;
  for (const std::uint32_t steps : {4U, 8U}) {
    ScannerStage stage(160, 48);
    stage.camera().patterns.steps = steps;
    stage.camera().illumination.ambient_w_per_m2 = 0.3;
    stage.use_noise(20000.0, 15.0);
    stage.panels.add_wall(0.8);
    const Frame one = stage.shoot(1);
    const Frame other = stage.shoot(2);
    const Beams beams = make_beams(stage.sensor);
    double sum = 0.0;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      ASSERT_EQ(one.status[i], Status::hit);
      ASSERT_EQ(other.status[i], Status::hit);
      const FringeLight light = fringe_light_of(one, steps, i);
      const double e_per_level = 20000.0 / 65535.0;
      const double sigma_e = std::sqrt(light.mean_e + 15.0 * 15.0 + e_per_level * e_per_level / 12);
      const double sigma_rad = std::sqrt(2.0 / steps) * sigma_e / light.amplitude_e;
      const double difference_m = depth_of(one, beams, i) - depth_of(other, beams, i);
      sum += std::pow(difference_m / depth_error_m(0.8, 32.0, sigma_rad), 2) / 2.0;
    }
    EXPECT_NEAR(std::sqrt(sum / static_cast<double>(beams.size())), 1.0, kTolerance) << steps;
  }
}

// A second harmonic of 1/4, which three steps turn by -3 phi: see FringeDecoder's test of gamma.
TEST(StructuredLightCameras, HaveTheRippleOfAGammaThatIsNotCompensated) {
  constexpr double kPeriod_px = 128.0;
  // Levels round by 1/2 of 255, light of gamma 2 by up to twice that; its amplitude is 1/2.
  constexpr double kTolerance_rad = 2.0 * kMaxRoundingError_rad;
  ScannerStage stage;
  stage.camera().patterns.steps = 3;
  stage.camera().patterns.period_px = kPeriod_px;
  stage.camera().light = {.power_w = 0.5, .gamma = 2.0, .blur_px = 0.0};
  stage.camera().imager.blur_px = 0.0;
  stage.panels.add_wall(0.8);
  const Beams beams = make_beams(stage.sensor);
  const auto max_error = [&](bool is_compensated) {
    stage.camera().patterns.gamma = is_compensated ? 2.0 : 1.0;
    const Frame frame = stage.shoot();
    double largest = 0.0;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      const double x = stage_coordinate_px(0.8 / beams.directions[i].z() * beams.directions[i]);
      const double phi = kTwoPi * (x + 0.5) / kPeriod_px;
      const double ripple = -std::atan2(std::sin(3.0 * phi), 4.0 + std::cos(3.0 * phi));
      const double error = (double{frame.projector_px[i]} - x) * kTwoPi / kPeriod_px;
      EXPECT_NEAR(error, is_compensated ? 0.0 : ripple, kTolerance_rad) << i;
      largest = std::max(largest, std::abs(error));
    }
    return largest;
  };
  EXPECT_NEAR(max_error(false), std::asin(0.25), kTolerance_rad);
  EXPECT_LT(max_error(true), kTolerance_rad);
}

void expect_same_bytes(const Frame& a, const Frame& b) {
  ASSERT_EQ(a.raw_images.size(), b.raw_images.size());
  for (std::size_t k = 0; k < a.raw_images.size(); ++k) {
    EXPECT_EQ(a.raw_images[k].grey.level, b.raw_images[k].grey.level) << k;
    EXPECT_EQ(a.raw_images[k].electrons, b.raw_images[k].electrons) << k;
  }
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(0, std::memcmp(a.range_m.data(), b.range_m.data(), a.range_m.size() * sizeof(double)));
  EXPECT_EQ(0, std::memcmp(a.projector_px.data(), b.projector_px.data(),
                           a.projector_px.size() * sizeof(float)));
}

TEST(StructuredLightCameras, AreTheSameForAnyThreadsAndRenderers) {
  ScannerStage stage;
  stage.use_noise(20000.0, 15.0);
  stage.camera().illumination.sun_w_per_m2 = 0.5;
  stage.panels.add_wall(0.7, 0.0, 5.0);
  stage.panels.add_wall(0.8);
  const Frame expected = stage.shoot();
  for (const unsigned threads : {1U, 3U, 8U}) {
    stage.renderer = {.kind = threads == 3U ? "auto" : "rays", .threads = threads};
    expect_same_bytes(stage.shoot(), expected);
  }
  EXPECT_NE(stage.shoot(2).raw_images[0].grey.level, expected.raw_images[0].grey.level);
}

// The automatic exposure looks at lit pixels alone: a panel that covers a quarter of the image.
TEST(StructuredLightCameras, ExposeWhatTheProjectorLights) {
  ScannerStage stage;
  stage.camera().imager.blur_px = 0.0;
  stage.panels.add_panel({0.0, -1.0, 0.8}, {0.064, 0.0, 0.0}, {0.0, 2.0, 0.0});
  const Frame frame = stage.shoot();
  double sum = 0.0;
  std::size_t lit = 0;
  for (std::size_t i = 0; i < frame.status.size(); ++i) {
    if (frame.ground_truth.instance[i] == kInvalidId) continue;
    // a code image and its inverse make up the greatest light
    sum += double{frame.raw_images[4].electrons[i]} + double{frame.raw_images[5].electrons[i]};
    ++lit;
  }
  EXPECT_EQ(lit, 24U * 40U);
  EXPECT_NEAR(sum / static_cast<double>(lit) / 1e14, 0.4, 1e-4);
}

TEST(StructuredLightCameras, HaveIndependentNoiseInEachImage) {
  ScannerStage stage;
  stage.use_noise(20000.0, 15.0);
  stage.panels.add_wall(0.8);
  const Frame frame = stage.shoot();
  const auto noise_of = [&](std::size_t image, std::size_t i) {
    const RawImage& raw = frame.raw_images[image];
    return raw.grey.level[i] * 20000.0 / 65535.0 - double{raw.electrons[i]};
  };
  double product = 0.0;
  double square = 0.0;
  const std::size_t pixels = frame.status.size();
  for (std::size_t i = 0; i < pixels; ++i) {
    product += noise_of(4, i) * noise_of(5, i);
    square += noise_of(4, i) * noise_of(4, i) + noise_of(5, i) * noise_of(5, i);
  }
  // The standard error of 3,840 pixels is at most 0.016.
  EXPECT_NEAR(2.0 * product / square, 0.0, 0.06);
}

}  // namespace
}  // namespace glidar
