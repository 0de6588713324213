// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <simulate/scanner_stage.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>

#include <cmath>
#include <string>

namespace glidar {
namespace {

using testing::count_of;
using testing::kScannerBaseline_m;
using testing::kScannerFocal_px;
using testing::ScannerStage;

// The shadow of a panel's edge at x = 0 is f b (1/z1 - 1/z2) pixels wide.
TEST(StructuredLightStatus, HaveNoDepthInTheShadowOfTheProjector) {
  ScannerStage stage;
  stage.panels.add_wall(0.7, 0.0, 5.0);
  stage.panels.add_wall(0.8);
  const Frame frame = stage.shoot();
  const double width_px = kScannerFocal_px * kScannerBaseline_m * (1.0 / 0.7 - 1.0 / 0.8);
  constexpr std::size_t kBlur_px = 3;  // 4 standard deviations of blur, and a half pixel
  for (std::size_t i = 0; i < frame.status.size(); ++i) {
    const std::size_t column = i % 160;
    const double from_edge_px = 80.0 - static_cast<double>(column);
    if (from_edge_px > kBlur_px && from_edge_px < width_px - kBlur_px) {
      EXPECT_EQ(frame.status[i], Status::projector_shadow) << column;
      EXPECT_TRUE(std::isnan(frame.range_m[i]));
      EXPECT_TRUE(std::isnan(frame.projector_px[i]));
      EXPECT_EQ(frame.intensity[i], 0.0F);
    }
    if (from_edge_px > width_px + kBlur_px || from_edge_px < -double{kBlur_px}) {
      EXPECT_EQ(frame.status[i], Status::hit) << column;
    }
  }
  const auto shadow = static_cast<double>(count_of(frame, Status::projector_shadow)) / 24.0;
  EXPECT_NEAR(shadow, width_px, 2.0);
}

TEST(StructuredLightStatus, GiveEveryHoleItsCause) {
  ScannerStage stage(160, 4);
  stage.panels.add_panel({-0.2, -1.0, 0.8}, {0.1, 0.0, 0.0}, {0.0, 2.0, 0.0});  // pixels 0 to 17
  stage.panels
      .add_panel({-0.1, -1.0, 0.8}, {0.1, 0.0, 0.0}, {0.0, 2.0, 0.0})  // 18 to 79
      .diffuse.setConstant(1e-5F);
  stage.panels.add_panel({0.0, -1.0, 0.8}, {0.064, 0.0, 0.0}, {0.0, 2.0, 0.0});  // 80 to 119
  const Frame frame = stage.shoot();
  EXPECT_EQ(frame.status[8], Status::hit);
  EXPECT_EQ(frame.status[50], Status::low_modulation);
  EXPECT_EQ(frame.status[100], Status::hit);
  EXPECT_EQ(frame.status[140], Status::miss);
  stage.sensor.limits = {.near_m = 0.9};
  EXPECT_EQ(stage.shoot().status[100], Status::too_near);
  stage.sensor.limits = {.far_m = 0.7};
  EXPECT_EQ(stage.shoot().status[100], Status::too_far);
  stage.sensor.limits = {};
  stage.camera().decoding.min_code_difference = 65000.0;
  EXPECT_EQ(stage.shoot().status[100], Status::weak_code);
  stage.camera().decoding.min_code_difference = 100.0;
  stage.camera().imager.auto_exposure.target = 0.9;
  EXPECT_EQ(stage.shoot().status[100], Status::saturated);
  stage.camera().projector.intrinsics.cx += 300.0;  // the image ends before the last panel does
  stage.camera().imager.auto_exposure.target = 0.3;
  EXPECT_EQ(stage.shoot().status[118], Status::outside_projector);
}

TEST(StructuredLightStatus, HaveNoDepthWhereTheLensHasNoRay) {
  ScannerStage stage(48, 48);
  std::get<Pinhole>(stage.sensor.optics).distortion = RadialTangential{.max_radius = 0.05};
  stage.panels.add_wall(0.8);
  const Frame frame = stage.shoot();
  EXPECT_EQ(frame.status[0], Status::invalid_pixel);
  EXPECT_EQ(frame.raw_images[0].electrons[0], 0.0F);
  EXPECT_EQ(frame.status[24 * 48 + 24], Status::hit);
}

TEST(StructuredLightStatus, ByTheLawReportTheTrueDepth) {
  ScannerStage stage;
  stage.sensor.depth_model = DepthModel::law;
  stage.sensor.noise = {RangeGaussian{}};
  stage.panels.add_wall(0.8);
  const Frame frame = stage.shoot();
  EXPECT_TRUE(frame.raw_images.empty());
  EXPECT_TRUE(frame.projector_px.empty());
  EXPECT_EQ(count_of(frame, Status::hit), frame.status.size());
}

std::string refusal_of(const ScannerStage& stage) {
  return error_text([&] { static_cast<void>(stage.shoot()); });
}

TEST(StructuredLightStatus, RefuseWhatDoesNotFit) {
  ScannerStage stage;
  stage.panels.add_wall(0.8);
  stage.renderer.kind = "raster";  // light of the projector is no image
  EXPECT_THAT(refusal_of(stage), ::testing::HasSubstr("use --renderer rays"));
  stage.renderer.kind = "rays";
  stage.camera().projector_from_camera.translation().setZero();
  EXPECT_THAT(refusal_of(stage), ::testing::HasSubstr("position of the camera"));
  stage = ScannerStage();
  stage.camera().patterns.width = 100;
  EXPECT_THAT(refusal_of(stage), ::testing::HasSubstr("640x320, as the projector"));
  stage = ScannerStage(4000, 4000);
  stage.camera().sub_rays = 1;
  stage.camera().patterns.steps = 16;
  EXPECT_THAT(refusal_of(stage), ::testing::HasSubstr("28 images of 4000x4000"));
  stage = ScannerStage(4000, 4000);
  EXPECT_THAT(refusal_of(stage), ::testing::HasSubstr("too many rays"));
  stage = ScannerStage();
  stage.camera().image_interval_s = 0.5;
  EXPECT_THAT(refusal_of(stage), ::testing::HasSubstr("seconds from 0 to 4"));
}

}  // namespace
}  // namespace glidar
