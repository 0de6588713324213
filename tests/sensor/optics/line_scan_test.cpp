// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/windows.hpp"

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/optics/line_scan.hpp>

namespace glidar {
namespace {

/// 3 lines of 5 points at 15 scans per second, which does not divide a second into nanoseconds.
LineScan small_raster() {
  LineScan r;
  r.elevations_rad = {0.1, 0.0, -0.1};
  for (int i = -2; i <= 2; ++i) r.azimuths_rad.push_back(0.2 * i);
  r.point_ns = 1000.0;
  r.line_ns = 20'000.0;
  r.scan_hz = 15.0;
  return r;
}

Sensor sensor_of(LineScan raster) {
  Sensor sensor;
  sensor.rate_hz = raster.scan_hz;
  sensor.optics = std::move(raster);
  return sensor;
}

TEST(LineScan, EachFrameIsOneScanInItsGrid) {
  const Sensor sensor = sensor_of(small_raster());
  for (const std::uint32_t frame : {0U, 1U, 2U, 1000U}) {
    const Beams beams = make_beams(sensor, frame_interval(sensor, frame));
    validate(beams);
    ASSERT_EQ(beams.rows, 3U) << frame;
    ASSERT_EQ(beams.cols, 5U);
    EXPECT_NEAR(beams.times_ns[7], 22'000.0, 1.0);  // line 1, point 2; rounded to a nanosecond
    EXPECT_LT((beams.directions[5] - direction_at(-0.4, 0.0)).norm(), 1e-15);
    EXPECT_EQ(beams.rings[14], 2U);
  }
}

TEST(LineScan, BidirectionalReversesEverySecondLine) {
  LineScan r = small_raster();
  r.bidirectional = true;
  const Sensor sensor = sensor_of(r);
  const Beams beams = make_beams(sensor);
  EXPECT_LT((beams.directions[5] - direction_at(-0.4, 0.0)).norm(), 1e-15);
  EXPECT_EQ(beams.times_ns[5], 24'000U);  // column 0 comes last
  EXPECT_EQ(beams.times_ns[9], 20'000U);
}

TEST(LineScan, VerticalLinesRunAlongTheElevationAtEachAzimuth) {
  LineScan r = small_raster();
  r.lines = LineScan::Lines::vertical;
  const Beams beams = make_beams(sensor_of(r));
  validate(beams);
  ASSERT_EQ(beams.rows, 5U);
  ASSERT_EQ(beams.cols, 3U);
  EXPECT_LT((beams.directions[3] - direction_at(-0.2, 0.1)).norm(), 1e-15);  // line 1, point 0
  EXPECT_LT((beams.directions[5] - direction_at(-0.2, -0.1)).norm(), 1e-15);
  EXPECT_EQ(beams.times_ns[5], 22'000U);
  EXPECT_EQ(beams.rings[5], 1U);
  testing::expect_windows_join(r, 0, 300'000'000);
}

TEST(LineScan, IntervalsJoinWithoutGapOrOverlap) {
  testing::expect_windows_join(small_raster(), 0, 300'000'000);
  testing::expect_windows_join(small_raster(), -66'666'667, 100'000'001);
}

TEST(LineScan, OneLineIsATwoDimensionalScanner) {
  LineScan r;
  r.elevations_rad = {0.0};
  for (int i = 0; i <= 1080; ++i) r.azimuths_rad.push_back((-135.0 + 0.25 * i) * kDegree);
  r.point_ns = 1e9 / 40.0 / 1440.0;
  r.scan_hz = 40.0;
  const Beams beams = make_beams(sensor_of(r));
  EXPECT_EQ(beams.rows, 1U);
  EXPECT_EQ(beams.cols, 1081U);
  EXPECT_EQ(beams.directions[540], Eigen::Vector3d::UnitX());
}

TEST(LineScan, RejectsAScanLongerThanItsPeriod) {
  LineScan r = small_raster();
  r.line_ns = 1e8;
  EXPECT_THROW(make_beams(sensor_of(r)), Error);
  r = small_raster();
  r.line_ns = 100.0;  // shorter than its points
  EXPECT_THROW(make_beams(sensor_of(r)), Error);
}

}  // namespace
}  // namespace glidar
