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
  sensor.optics = RayTable{.rows = 1,
                           .cols = 1,
                           .directions = {Eigen::Vector3d::UnitX()},
                           .times_ns = {7.0},
                           .period_ns = 5.0};
  EXPECT_EQ(error_text([&] { make_beams(sensor); }),
            "sensor 'front': optics, times: 7; allowed: from 0 to half a nanosecond before the "
            "period's end");
}

}  // namespace
}  // namespace glidar
