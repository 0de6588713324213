// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/noise/noise.hpp>
#include <sensor/noise_stage.hpp>

namespace glidar {
namespace {

using testing::NoiseStage;

TEST(ApplyNoise, RemovesNonPositiveRangesAfterTheLastStepOnly) {
  NoiseStage stage(4, 4, 3.0);
  const RangeBias away{.offset_m = -5.0};
  const RangeBias back{.offset_m = 5.0};
  const std::vector<NoiseStep> at_once = {away, back};
  const std::vector<NoiseStep> in_stretches = {away, Crosstalk{}, back};
  for (const auto& noise : {at_once, in_stretches}) {
    stage.reset(3.0);
    stage.apply(noise);
    EXPECT_EQ(stage.frame.status[0], Status::hit);
    EXPECT_NEAR(stage.frame.range_m[0], 3.0, 1e-12);
  }
  stage.reset(3.0);
  stage.apply({away});
  EXPECT_EQ(stage.frame.status[0], Status::too_near);
}

TEST(ApplyNoisePrefix, KeepsNonPositiveRangesBeforeTheLastStep) {
  NoiseStage stage(1, 4, 3.0);
  const std::vector<NoiseStep> noise = {RangeBias{.offset_m = -5.0}, RangeBias{.offset_m = 5.0}};
  apply_noise(plan_noise(noise, 0.1), stage.beams, stage.thread_pool, stage.workspace, stage.frame,
              1);
  EXPECT_EQ(stage.frame.status[0], Status::hit);
  EXPECT_NEAR(stage.frame.range_m[0], -2.0, 1e-12);
}

}  // namespace
}  // namespace glidar
