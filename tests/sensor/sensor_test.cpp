// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/sensor.hpp>

#include <support/error_text.hpp>

#include <gtest/gtest.h>

namespace glidar {
namespace {

TEST(MakeBeams, ErrorsNameTheSensor) {
  Sensor sensor;
  sensor.name = "front";
  RayTable table;
  table.rows = 1;
  table.cols = 1;
  table.directions = {Eigen::Vector3d::UnitX()};
  table.times_ns = {7.0};
  table.period_ns = 5.0;
  sensor.optics = table;
  EXPECT_EQ(error_text([&] { make_beams(sensor); }),
            "sensor 'front': optics, times: 7; allowed: from 0 to half a nanosecond before the "
            "period's end");
}

}  // namespace
}  // namespace glidar
