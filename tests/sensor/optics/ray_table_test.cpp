// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/windows.hpp"

#include <glidar/core/error.hpp>
#include <glidar/sensor/optics/ray_table.hpp>

namespace glidar {
namespace {

RayTable spiral(std::uint32_t size) {
  RayTable table;
  table.rows = 1;
  table.cols = size;
  for (std::uint32_t i = 0; i < size; ++i) {
    table.directions.push_back(2.0 * direction_at(0.3 * i, 0.001 * i));
    table.times_ns.push_back(5000.0 * i);
  }
  table.period_ns = 5000.0 * size;
  return table;
}

TEST(RayTable, RepeatsPeriodically) {
  const RayTable table = spiral(1000);
  const Beams beams = make_beams(table, {2'500'000, 7'500'000});  // second half and a half more
  validate(beams);
  ASSERT_EQ(beams.cols, 1000U);
  EXPECT_LT((beams.directions[0] - 0.5 * table.directions[500]).norm(), 1e-15);
  EXPECT_LT((beams.directions[500] - 0.5 * table.directions[0]).norm(), 1e-15);
  EXPECT_EQ(beams.times_ns[500], 2'500'000U);
}

TEST(RayTable, IntervalsJoinWithoutGapOrOverlap) {
  testing::expect_windows_join(spiral(777), 0, 30'000'000);
}

TEST(RayTable, WithoutTimesIsFiredAtTheStartOfTheFrame) {
  RayTable table = spiral(6);
  table.times_ns.clear();
  table.rows = 2;
  table.cols = 3;
  table.origins_m.assign(6, Eigen::Vector3d(1, 2, 3));
  const Beams beams = make_beams(table, {12, 34});
  validate(beams);
  EXPECT_EQ(beams.rows, 2U);
  EXPECT_TRUE(beams.times_ns.empty());
  EXPECT_EQ(beams.origins_m[5], Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(beams.rings[3], 1U);
}

TEST(RayTable, RejectsArraysOfWrongSize) {
  RayTable table = spiral(6);
  table.directions.pop_back();
  EXPECT_THROW(make_beams(table, {0, 1}), Error);
  table = spiral(6);
  table.directions[2].setZero();
  EXPECT_THROW(make_beams(table, {0, 1}), Error);
  table = spiral(6);
  std::swap(table.times_ns[1], table.times_ns[2]);
  EXPECT_THROW(make_beams(table, {0, 1}), Error);
  table = spiral(6);
  table.period_ns = 100.0;
  EXPECT_THROW(make_beams(table, {0, 1}), Error);
}

}  // namespace
}  // namespace glidar
