// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <depth_camera/tof_pictures.hpp>
#include <glidar/depth_camera/time_of_flight.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

namespace glidar {
namespace {

using testing::expose_scene;
using ::testing::HasSubstr;
using testing::plain_camera;
using testing::TofTarget;

TofMeasurement decode_sample(const TofRun& run = {}) {
  const TofSample sample = sample_tof_images();
  return decode_tof(
      sample.images, sample.options,
      {.depth_per_range = sample.depth_per_range, .is_illuminated = sample.is_illuminated}, run);
}

TofStatus status_at(const TofMeasurement& measured, std::size_t column, std::size_t row) {
  return measured.status[row * measured.width + column];
}

TEST(TofStatuses, EachPartOfTheSampleHasItsCause) {
  const TofMeasurement measured = decode_sample();
  EXPECT_EQ(status_at(measured, 80, 60), TofStatus::valid);
  EXPECT_EQ(status_at(measured, 30, 30), TofStatus::valid);
  EXPECT_EQ(status_at(measured, 1, 1), TofStatus::not_illuminated);
  EXPECT_EQ(status_at(measured, 48, 97), TofStatus::low_signal);
  EXPECT_EQ(status_at(measured, 96, 97), TofStatus::saturated);
  EXPECT_EQ(status_at(measured, 155, 60), TofStatus::too_far);
  std::array<std::size_t, kTofStatusCount> counts{};
  for (const TofStatus status : measured.status) ++counts[static_cast<std::size_t>(status)];
  EXPECT_GT(counts[static_cast<std::size_t>(TofStatus::edge)], 100U);  // around the disc
}

TEST(TofStatuses, ValidPixelsOfTheSampleHaveTheTrueRange) {
  const TofMeasurement measured = decode_sample();
  EXPECT_NEAR(measured.range_m[60 * 160 + 80], 1.2, 0.01);
  const double x = (30.5 - 80.0) / 150.0;
  const double y = (30.5 - 60.0) / 150.0;
  EXPECT_NEAR(measured.range_m[30 * 160 + 30],
              3.0 / (1.0 - 0.8 * x) * std::sqrt(1.0 + x * x + y * y), 0.03);
}

TEST(TofStatuses, PixelsWithoutARangeAreNotANumber) {
  const TofMeasurement measured = decode_sample();
  for (std::size_t i = 0; i < measured.status.size(); ++i) {
    EXPECT_EQ(std::isnan(measured.range_m[i]), measured.status[i] != TofStatus::valid);
  }
}

TEST(TofStatuses, ThreadsDoNotChangeTheBytes) {
  const TofMeasurement alone = decode_sample();
  for (const unsigned threads : {1U, 2U, 8U}) {
    ThreadPool pool(threads);
    const TofMeasurement shared = decode_sample({.pool = &pool});
    EXPECT_EQ(shared.status, alone.status);
    EXPECT_EQ(0, std::memcmp(shared.range_m.data(), alone.range_m.data(),
                             alone.range_m.size() * sizeof(double)));
    EXPECT_EQ(0, std::memcmp(shared.phase_rad.data(), alone.phase_rad.data(),
                             alone.phase_rad.size() * sizeof(float)));
  }
}

/// Two walls that share the pixels of the middle column by halves.
TofImages mixed_step(const TofCamera& camera, double near_m, double far_m) {
  const auto wall = [&](double range_m) {
    return expose_scene(camera, 9, 5, [=](std::uint32_t, std::uint32_t) {
      return TofTarget{.range_m = range_m, .electrons = 500.0};
    });
  };
  TofImages images = wall(near_m);
  const TofImages behind = wall(far_m);
  for (std::size_t i = 0; i < images.level.size(); ++i) {
    const std::size_t column = i % 9;
    if (column > 4) images.level[i] = behind.level[i];
    if (column == 4) images.level[i] = 0.5F * (images.level[i] + behind.level[i]);
  }
  return images;
}

TEST(TofStatuses, MixedLightIsBetweenTheWallsWithoutTestsAndAnEdgeWithThem) {
  TofCamera camera = plain_camera({20e6}, 4);
  const TofImages images = mixed_step(camera, 1.5, 2.5);
  EXPECT_NEAR(decode_tof(images, camera.decoder).range_m[2 * 9 + 4], 2.0, 1e-4);
  camera.decoder.edge_test = TofEdgeTest{};
  const TofMeasurement tested = decode_tof(images, camera.decoder);
  EXPECT_EQ(status_at(tested, 4, 2), TofStatus::edge);
  EXPECT_EQ(status_at(tested, 2, 2), TofStatus::valid);
  EXPECT_EQ(status_at(tested, 6, 2), TofStatus::valid);
}

TEST(TofStatuses, MixedLightOfDifferentPeriodsIsAmbiguous) {
  const TofCamera camera = plain_camera({80e6, 16e6, 120e6}, 3);
  const TofImages images = mixed_step(camera, 1.0, 2.1);
  EXPECT_EQ(status_at(decode_tof(images, camera.decoder), 4, 2), TofStatus::ambiguous);
}

TEST(TofStatuses, PhaseChangesMarkEdgesWhereTheFilterIsUsed) {
  TofCamera camera = plain_camera({80e6}, 4);
  camera.decoder.filter = TofFilter{};
  const TofMeasurement measured = decode_tof(mixed_step(camera, 0.3, 1.2), camera.decoder);
  EXPECT_EQ(status_at(measured, 4, 2), TofStatus::edge);
  EXPECT_EQ(status_at(measured, 1, 2), TofStatus::valid);
}

TEST(TofStatuses, TheFilterReducesTheNoiseOfAWall) {
  TofCamera camera = plain_camera({80e6}, 4);
  const TofImages images = testing::expose_noisy_scene(
      camera, 60, 60,
      [](std::uint32_t, std::uint32_t) { return TofTarget{.range_m = 0.9, .electrons = 3000.0}; },
      3);
  const auto spread = [&] {
    const TofMeasurement measured = decode_tof(images, camera.decoder);
    double squares = 0.0;
    for (std::size_t row = 1; row < 59; ++row) {
      for (std::size_t column = 1; column < 59; ++column) {
        squares += std::pow(measured.range_m[row * 60 + column] - 0.9, 2.0);
      }
    }
    return std::sqrt(squares / (58.0 * 58.0));
  };
  const double raw = spread();
  camera.decoder.filter = TofFilter{};
  // Nine independent pixels with nearly equal weights.
  EXPECT_NEAR(spread() / raw, 1.0 / 3.0, 0.03);
}

TEST(TofStatuses, SaturationIsALevelOrAnInfiniteValue) {
  TofCamera camera = plain_camera({80e6}, 4);
  camera.full_well_electrons = 900.0;
  const TofImages full = expose_scene(camera, 1, 1, [](std::uint32_t, std::uint32_t) {
    return TofTarget{.range_m = 0.0, .electrons = 1000.0};
  });
  EXPECT_EQ(decode_tof(full, camera.decoder).status[0], TofStatus::saturated);
  camera.full_well_electrons = 1100.0;
  const TofImages filled = expose_scene(camera, 1, 1, [](std::uint32_t, std::uint32_t) {
    return TofTarget{.range_m = 0.3, .electrons = 1000.0};
  });
  EXPECT_EQ(decode_tof(filled, camera.decoder).status[0], TofStatus::valid);
  camera.decoder.saturation_level = 500.0;
  EXPECT_EQ(decode_tof(filled, camera.decoder).status[0], TofStatus::saturated);
}

TEST(TofStatuses, PhaseOffsetsAreSubtracted) {
  const TofCamera camera = plain_camera({80e6}, 4);
  const TofImages images = expose_scene(
      camera, 1, 1, [](std::uint32_t, std::uint32_t) { return TofTarget{.range_m = 1.0}; });
  const std::vector<float> offset = {0.5F};
  const double expected = 1.0 - 0.5 * 299792458.0 / (4.0 * std::numbers::pi * 80e6);
  EXPECT_NEAR(decode_tof(images, camera.decoder, {.phase_offset_rad = offset}).range_m[0], expected,
              1e-6);
}

TEST(TofStatuses, DepthLimitsApplyAlongTheBoresight) {
  TofCamera camera = plain_camera({16e6}, 4);
  camera.decoder.near_m = 0.9;
  camera.decoder.far_m = 1.1;
  const TofImages images = expose_scene(camera, 3, 1, [](std::uint32_t column, std::uint32_t) {
    return TofTarget{.range_m = 1.0 + 0.14 * column};
  });
  const std::vector<float> cosine = {0.85F, 0.85F, 0.85F};
  const TofMeasurement measured = decode_tof(images, camera.decoder, {.depth_per_range = cosine});
  EXPECT_EQ(measured.status[0], TofStatus::too_near);
  EXPECT_EQ(measured.status[1], TofStatus::valid);
  EXPECT_EQ(measured.status[2], TofStatus::valid);
  EXPECT_EQ(decode_tof(images, camera.decoder).status[2], TofStatus::too_far);
}

TEST(TofTraces, NameTheTestThatAPixelFails) {
  const TofSample sample = sample_tof_images();
  const TofCalibration calibration{.depth_per_range = sample.depth_per_range,
                                   .is_illuminated = sample.is_illuminated};
  const TofMeasurement measured = decode_tof(sample.images, sample.options, calibration);
  for (std::uint32_t i = 0; i < measured.status.size(); i += 1013) {
    const TofTrace trace =
        explain_tof(sample.images, sample.options, {i % 160, i / 160}, calibration);
    EXPECT_EQ(trace.status, measured.status[i]);
    const auto failed = std::find_if(trace.tests.begin(), trace.tests.end(),
                                     [](const TofTest& test) { return !test.has_passed; });
    EXPECT_EQ(failed == trace.tests.end() ? TofStatus::valid : failed->failure, trace.status) << i;
  }
}

TEST(TofTraces, PrintPhasesTestsAndCandidates) {
  const TofSample sample = sample_tof_images();
  const TofTrace trace = explain_tof(sample.images, sample.options, {80, 60});
  EXPECT_EQ(trace.candidates.size(), 15U);
  EXPECT_NEAR(trace.candidates[0].range_m, trace.range_m, 1e-9);
  const std::string text = format_tof_trace(trace);
  EXPECT_THAT(text, HasSubstr("pixel 80,60: valid\nrange 1.1998 m"));
  EXPECT_THAT(text, HasSubstr("  80.000 MHz: raw "));
  EXPECT_THAT(text, HasSubstr("  passed  low_signal: least amplitude "));
  EXPECT_THAT(text, HasSubstr(" rad, whole periods 0 0 0\n"));
}

}  // namespace
}  // namespace glidar
