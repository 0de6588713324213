// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Time-of-flight cameras from the scene to the frame.
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/simulate/explain.hpp>
#include <simulate/tof_stage.hpp>
#include <support/data.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace glidar {
namespace {

using testing::TofStage;

std::size_t count(const Frame& frame, Status status) {
  return static_cast<std::size_t>(std::count(frame.status.begin(), frame.status.end(), status));
}

TofStage wall_stage(double depth_m) {
  TofStage stage({80e6, 60e6}, 4);
  stage.panels.add_wall(depth_m);
  stage.sensor.optics = pinhole_from_fov(32, 24, 0.8);
  return stage;
}

TEST(TofCameras, MeasureTheRangeOfAWall) {
  const TofStage stage = wall_stage(2.3);
  const Frame frame = stage.shoot();
  ASSERT_EQ(count(frame, Status::hit), frame.status.size());
  for (std::size_t i = 0; i < frame.range_m.size(); ++i) {
    // The mean over a pixel of 0.034 rad differs from the range of its centre.
    EXPECT_NEAR(frame.range_m[i], frame.ground_truth.range_m[i], 5e-4);
  }
}

TEST(TofCameras, SignalsFallWithTheSquareOfTheRange) {
  const auto middle = [](const Frame& frame) { return frame.intensity[12 * 32 + 16]; };
  const double near = double{middle(wall_stage(1.0).shoot())};
  const double far = double{middle(wall_stage(2.0).shoot())};
  EXPECT_NEAR(near / far, 4.0, 0.01);
  // white at normal incidence at 1 m: the signal itself
  TofStage stage = wall_stage(1.0);
  stage.panels.scene.materials[0].diffuse.setConstant(0.5F);
  EXPECT_NEAR(double{middle(stage.shoot())} / 1e14, 0.5, 0.005);
}

TEST(TofCameras, RangesWrapBeyondTheUnambiguousOne) {
  const double unambiguous_m = kHalfLight_m_per_s / 20e6;
  TofStage stage = wall_stage(unambiguous_m + 1.0);
  stage.sensor.optics = pinhole_from_fov(4, 4, 0.001);
  const Frame frame = stage.shoot();
  EXPECT_NEAR(frame.range_m[5], 1.0, 1e-3);
}

/// A near panel that covers the left of the image, before a wall.
TofStage step_stage() {
  TofStage stage({20e6}, 4);
  stage.panels.add_wall(1.0, -50.0, 0.004);
  stage.panels.add_wall(2.0);
  stage.sensor.optics = pinhole_from_fov(64, 8, 0.1);
  return stage;
}

/// Pixels with a depth that neither surface has.
std::size_t count_between(const Sensor& sensor, const Frame& frame) {
  const Beams beams = make_beams(sensor);
  std::size_t between = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const double depth_m = frame.range_m[i] * beams.directions[i].z();
    between += depth_m > 1.05 && depth_m < 1.95 ? 1 : 0;
  }
  return between;
}

TEST(TofCameras, PixelsAtAStepFlyBetweenBothSurfaces) {
  TofStage stage = step_stage();
  stage.camera().sub_rays = 8;
  const Frame frame = stage.shoot();
  EXPECT_EQ(count_between(stage.sensor, frame), 8U);  // one pixel of each row
  stage.camera().sub_rays = 1;
  EXPECT_EQ(count_between(stage.sensor, stage.shoot()), 0U);
}

TEST(TofCameras, TheEdgeTestRemovesFlyingPixels) {
  TofStage stage = step_stage();
  stage.camera().sub_rays = 8;
  stage.camera().decoder.edge_test = TofEdgeTest{};
  const Frame frame = stage.shoot();
  EXPECT_EQ(count(frame, Status::filtered_edge), 6U);  // not in the first and last row
}

TEST(TofCameras, EveryLostPixelHasItsCause) {
  TofStage stage({16e6}, 4);
  stage.panels.add_panel({-1.0, -5.0, 1.0}, {0.5, 0.0, 0.0}, {0.0, 10.0, 0.0});
  stage.panels.add_panel({-0.5, -5.0, 1.0}, {0.5, 0.0, 0.0}, {0.0, 10.0, 0.0})
      .diffuse.setConstant(1e-6F);
  stage.panels.add_panel({0.0, -5.0, 1.0}, {0.5, 0.0, 0.0}, {0.0, 10.0, 0.0})
      .diffuse.setConstant(0.1F);
  stage.sensor.optics = pinhole_from_fov(40, 1, 2.0 * std::atan(0.025));
  stage.camera().signal_electrons = 1e5;
  stage.camera().full_well_electrons = 2e4;
  stage.camera().decoder.min_amplitude = 50.0;
  const Frame frame = stage.shoot();
  EXPECT_EQ(frame.status[5], Status::saturated);
  EXPECT_EQ(frame.status[15], Status::below_threshold);
  EXPECT_EQ(frame.status[25], Status::hit);
  EXPECT_EQ(frame.status[35], Status::miss);
  stage.sensor.limits.far_m = 0.9;
  EXPECT_EQ(stage.shoot().status[25], Status::too_far);
}

/// A wall that moves away at 2 m/s, of which 4 phase steps of 2 frequencies are taken in turn.
TofStage moving_stage(double speed_m_s) {
  TofStage stage({80e6, 16e6}, 4);
  stage.panels.add_wall(1.5);
  stage.world_from_instance = {ConstantTwist{.linear_m_s = Eigen::Vector3d(0.0, 0.0, speed_m_s)}};
  stage.camera().step_interval_s = 0.001;
  stage.camera().sub_rays = 1;
  stage.sensor.optics = pinhole_from_fov(5, 5, 0.5);
  return stage;
}

/// The range of a pixel by its raw values one by one, in double.
double brute_force_range_m(const Eigen::Vector3d& direction, double speed_m_s) {
  const std::array<double, 2> f = {80e6, 16e6};
  std::array<double, 2> turns{};
  for (std::size_t j = 0; j < 2; ++j) {
    double x = 0.0;
    double y = 0.0;
    for (int k = 0; k < 4; ++k) {
      const double t = 0.001 * (4.0 * static_cast<double>(j) + k);
      const double range_m = (1.5 + speed_m_s * t) / direction.z();
      const double phase = 4.0 * std::numbers::pi * f[j] * range_m / kLight_m_per_s;
      const double value = std::cos(phase - kTwoPi * k / 4.0) / (range_m * range_m);
      x += value * std::cos(kTwoPi * k / 4.0);
      y += value * std::sin(kTwoPi * k / 4.0);
    }
    turns[j] = std::atan2(y, x) / kTwoPi;
  }
  const double per_m = 1.0 / kHalfLight_m_per_s;
  double best_m = 0.0;
  double best = 1e9;
  for (int a = 0; a < 6; ++a) {
    for (int b = 0; b < 2; ++b) {
      const std::array<double, 2> t = {turns[0] + a, turns[1] + b};
      const double squares = (f[0] * f[0] + f[1] * f[1]) * per_m * per_m;
      const double range_m = (t[0] * f[0] + t[1] * f[1]) * per_m / squares;
      const double misfit =
          std::hypot(t[0] - range_m * f[0] * per_m, t[1] - range_m * f[1] * per_m);
      if (misfit >= best) continue;
      best = misfit;
      best_m = range_m;
    }
  }
  return best_m;
}

TEST(TofCameras, EachPhaseStepSeesAMovingWallAtItsOwnTime) {
  const TofStage stage = moving_stage(2.0);
  const Frame frame = stage.shoot();
  const Beams beams = make_beams(stage.sensor);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    EXPECT_NEAR(frame.range_m[i], brute_force_range_m(beams.directions[i], 2.0), 1e-4);
    // Motion between the steps matters: 1.5 ms are 3 mm, and the phase errs beyond them.
    EXPECT_GT(std::abs(frame.range_m[i] - frame.ground_truth.range_m[i]), 1e-3);
  }
}

TEST(TofCameras, AWallOfSpeedZeroIsAWallAtRest) {
  const Frame moving = moving_stage(0.0).shoot();
  TofStage still = moving_stage(0.0);
  still.world_from_instance.clear();
  const Frame rest = still.shoot();
  for (std::size_t i = 0; i < rest.range_m.size(); ++i) {
    EXPECT_NEAR(moving.range_m[i], rest.range_m[i], 1e-6);
  }
}

TofStage asteroid_stage() {
  TofStage stage({80e6, 16e6, 120e6}, 3);
  stage.panels.scene = testing::scene_of(make_builtin_model("asteroid"));
  stage.panels.add_panel({-3.0, -3.0, -1.0}, {6.0, 0.0, 0.0}, {0.0, 6.0, 0.0});
  stage.world_from_sensor = look_at({1.6, -1.2, 0.8}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  stage.sensor.optics = pinhole_from_fov(48, 36, 0.9);
  stage.camera().signal_electrons = 3e4;
  stage.camera().ambient_electrons = 500.0;
  stage.camera().read_noise_electrons = 5.0;
  stage.camera().bounces = 2;
  stage.camera().bounce_rays = 8;
  stage.camera().decoder.filter = TofFilter{};
  return stage;
}

void expect_same_bytes(const Frame& a, const Frame& b) {
  ASSERT_EQ(a.tof_images.level.size(), b.tof_images.level.size());
  EXPECT_EQ(0, std::memcmp(a.tof_images.level.data(), b.tof_images.level.data(),
                           a.tof_images.level.size() * sizeof(float)));
  EXPECT_EQ(0, std::memcmp(a.range_m.data(), b.range_m.data(), a.range_m.size() * sizeof(double)));
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.bounced_share, b.bounced_share);
}

TEST(TofCameras, ThreadsAndRenderersDoNotChangeTheBytes) {
  TofStage stage = asteroid_stage();
  const Frame reference = stage.shoot();
  EXPECT_GT(count(reference, Status::hit), 300U);
  for (const unsigned threads : {1U, 3U, 8U}) {
    stage.renderer.threads = threads;
    expect_same_bytes(stage.shoot(), reference);
  }
  stage.renderer.kind = "rays";
  expect_same_bytes(stage.shoot(), reference);
  stage.camera().bounces = 0;  // bounces are no image, so the raster renderer cannot cast them
  const Frame direct = stage.shoot();
  stage.renderer.kind = "raster";
  expect_same_bytes(stage.shoot(), direct);
  EXPECT_NE(stage.shoot(2).tof_images.level, reference.tof_images.level);
}

TEST(TofCameras, ExplainReportsThePhotonsAndTheDecodingOfAPixel) {
  const TofStage stage = asteroid_stage();
  const Frame measured = stage.shoot();
  const auto renderer = make_renderer(stage.panels.scene, stage.renderer);
  Simulator simulator(stage.panels.scene, stage.sensor, *renderer);
  for (const std::size_t entry : {std::size_t{0}, std::size_t{18 * 48 + 24}}) {
    Frame frame;
    frame.seed = 1;
    const PointTrace trace = explain(
        simulator, static_motion(stage.panels.scene, stage.world_from_sensor), entry, frame);
    ASSERT_TRUE(trace.depth);
    const auto& pixel = std::get<TofPixelTrace>(*trace.depth);
    EXPECT_EQ(pixel.light.size(), 9U);
    EXPECT_FLOAT_EQ(static_cast<float>(pixel.bounced_share), measured.bounced_share[entry]);
    EXPECT_EQ(trace.measured.status, measured.status[entry]);
    if (measured.status[entry] != Status::hit) continue;
    EXPECT_EQ(pixel.decoded.range_m, measured.range_m[entry]);
    const bool is_surface = measured.ground_truth.instance[entry] != kInvalidId;
    EXPECT_EQ(pixel.light[0].signal > 0.0, is_surface);
    EXPECT_EQ(measured.return_source[entry],
              is_surface ? ReturnSource::surface : ReturnSource::false_alarm);
  }
}

TEST(TofCameras, LensDistortionMovesTheRays) {
  TofStage stage = wall_stage(2.0);
  std::get<Pinhole>(stage.sensor.optics).distortion = RadialTangential{.k1 = -0.2};
  const Frame frame = stage.shoot();
  const Beams beams = make_beams(stage.sensor);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    EXPECT_NEAR(frame.range_m[i], 2.0 / beams.directions[i].z(), 1e-3);
  }
}

}  // namespace
}  // namespace glidar
