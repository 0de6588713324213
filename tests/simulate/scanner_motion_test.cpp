// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/explain/trace_text.hpp>
#include <glidar/simulate/explain.hpp>
#include <simulate/scanner_stage.hpp>

#include <gmock/gmock.h>

#include <cmath>

namespace glidar {
namespace {

using testing::count_of;
using testing::depth_error_m;
using testing::is_at_border;
using testing::kMaxRoundingError_rad;
using testing::kProjectorFocal_px;
using testing::kScannerBaseline_m;
using testing::ScannerStage;
using testing::stage_coordinate_px;

constexpr double kInterval_s = 0.001;
constexpr double kPeriod_px = 32.0;

/// A wall that is at 0.8 m when the frame starts and moves away; an image each millisecond.
ScannerStage moving_stage(double speed_m_s) {
  ScannerStage stage;
  stage.camera().image_interval_s = kInterval_s;
  stage.panels.add_wall(0.8);
  stage.world_from_instance = {ConstantTwist{.linear_m_s = Eigen::Vector3d(0.0, 0.0, speed_m_s)}};
  return stage;
}

/// The phase of a pixel minus that of the wall at the start, from the four levels one by one.
double brute_force_error_rad(const Eigen::Vector3d& direction, double speed_m_s) {
  double x = 0.0;
  double y = 0.0;
  double first_rad = 0.0;
  for (int k = 0; k < 4; ++k) {
    const double z_m = 0.8 + speed_m_s * kInterval_s * k;
    const Eigen::Vector3d point = z_m / direction.z() * direction;
    const Eigen::Vector3d path = point - Eigen::Vector3d(kScannerBaseline_m, 0.0, 0.0);
    const double phase = kTwoPi * (stage_coordinate_px(point) + 0.5) / kPeriod_px;
    if (k == 0) first_rad = phase;
    const double light = path.z() / std::pow(path.norm(), 3);
    const double level = light * (1.0 + std::cos(phase - kTwoPi * k / 4.0));
    x += level * std::cos(kTwoPi * k / 4.0);
    y += level * std::sin(kTwoPi * k / 4.0);
  }
  return std::remainder(std::atan2(y, x) - first_rad, kTwoPi);
}

// Each image sees a shift of e = 2 pi / T f b v t / z^2, so the phase errs by (N - 1) / 2 e on
// average, and by e / (2 sin(2 pi / N)) about it.
TEST(MovingScannerTargets, HaveThePhaseErrorOfTheirMotion) {
  constexpr double kSpeed_m_s = 2.0;
  constexpr double kTolerance_rad = kMaxRoundingError_rad + 0.001;  // interpolation, uneven light
  const ScannerStage stage = moving_stage(kSpeed_m_s);
  const Frame frame = stage.shoot();
  const Beams beams = make_beams(stage.sensor);
  double sum_rad = 0.0;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    ASSERT_EQ(frame.status[i], Status::hit) << i;
    if (is_at_border(frame, i)) continue;
    const double start_px =
        stage_coordinate_px(0.8 / beams.directions[i].z() * beams.directions[i]);
    const double error_rad = (double{frame.projector_px[i]} - start_px) * kTwoPi / kPeriod_px;
    EXPECT_NEAR(error_rad, brute_force_error_rad(beams.directions[i], kSpeed_m_s), kTolerance_rad)
        << i;
    sum_rad += error_rad;
    ++compared;
  }
  const double mean = sum_rad / static_cast<double>(compared);
  const double step_rad = kTwoPi / kPeriod_px * kProjectorFocal_px * kScannerBaseline_m *
                          kSpeed_m_s * kInterval_s / (0.8 * 0.8);
  EXPECT_NEAR(mean, 1.5 * step_rad, kTolerance_rad);
  EXPECT_GT(mean, 10.0 * kTolerance_rad);
}

TEST(MovingScannerTargets, ThatAreFastContradictTheirCode) {
  EXPECT_EQ(count_of(moving_stage(0.5).shoot(), Status::inconsistent_code), 0U);
  const Frame fast = moving_stage(6.0).shoot();
  EXPECT_GT(count_of(fast, Status::inconsistent_code), fast.status.size() / 10);
}

TEST(MovingScannerTargets, OfSpeedZeroAreAtRest) {
  const ScannerStage moving = moving_stage(0.0);
  ScannerStage still = moving_stage(0.0);
  still.world_from_instance.clear();
  const Frame a = moving.shoot();
  const Frame b = still.shoot();
  for (std::size_t i = 0; i < a.range_m.size(); ++i) EXPECT_NEAR(a.range_m[i], b.range_m[i], 1e-6);
}

// A sensor that backs away sees what it sees of a wall that does, also in sunlight from the side.
TEST(MovingScannerTargets, MoveRelativeToTheSensor) {
  ScannerStage wall = moving_stage(2.0);
  wall.camera().illumination = {
      .ambient_w_per_m2 = 0.1, .sun_w_per_m2 = 0.1, .sun_direction = {1.0, 0.0, -2.0}};
  ScannerStage sensor = wall;
  sensor.world_from_instance.clear();
  sensor.motion = ConstantTwist{.linear_m_s = Eigen::Vector3d(0.0, 0.0, -2.0)};
  const Frame a = wall.shoot();
  const Frame b = sensor.shoot();
  for (std::size_t i = 0; i < a.range_m.size(); ++i) {
    EXPECT_NEAR(a.range_m[i], b.range_m[i], 1e-6) << i;
  }
}

TEST(MovingScannerTargets, AreFrozenWithoutAnInterval) {
  ScannerStage stage = moving_stage(2.0);
  stage.camera().image_interval_s = 0.0;
  const Frame frame = stage.shoot();
  const Beams beams = make_beams(stage.sensor);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (is_at_border(frame, i)) continue;
    EXPECT_NEAR(frame.range_m[i] * beams.directions[i].z(), 0.8,
                depth_error_m(0.8, kPeriod_px, kMaxRoundingError_rad + 0.001));
  }
}

TEST(MovingScannerTargets, AreExplainedByTheirImages) {
  const ScannerStage stage = moving_stage(2.0);
  const Frame measured = stage.shoot();
  const auto renderer = make_renderer(stage.panels.scene, stage.renderer);
  Simulator simulator(stage.panels.scene, stage.sensor, *renderer);
  const Motion motion = make_motion(stage.panels.scene, ConstantPose{}, stage.world_from_instance);
  const std::size_t entry = 12 * 160 + 80;
  Frame frame;
  frame.seed = 1;
  const PointTrace trace = explain(simulator, motion, entry, frame);
  ASSERT_TRUE(trace.depth);
  const auto& pixel = std::get<StructuredLightPixelTrace>(*trace.depth);
  ASSERT_EQ(pixel.decoded.levels.size(), measured.raw_images.size());
  for (std::size_t k = 0; k < measured.raw_images.size(); ++k) {
    EXPECT_EQ(pixel.decoded.levels[k], measured.raw_images[k].grey.level[entry]);
    EXPECT_EQ(pixel.electrons[k], double{measured.raw_images[k].electrons[entry]});
  }
  EXPECT_EQ(static_cast<float>(pixel.decoded.coordinate_px), measured.projector_px[entry]);
  const Beams beams = make_beams(stage.sensor);
  EXPECT_NEAR(pixel.true_projector_px,
              stage_coordinate_px(0.8 / beams.directions[entry].z() * beams.directions[entry]),
              1e-9);
  EXPECT_EQ(trace.measured.range_m, measured.range_m[entry]);
  EXPECT_EQ(pixel.decoded.column, 80U);
  EXPECT_EQ(pixel.decoded.row, 12U);
}

}  // namespace
}  // namespace glidar
