// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/lockstep_run.hpp>

#include <glidar/core/point_cloud.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/link/lockstep.hpp>

#include "support/data.hpp"
#include "support/error_text.hpp"
#include "support/simulate.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace glidar::app {
namespace {

TEST(ReplySize, OfEachColumnIsThatOfItsNumbers) {
  const Scene scene = testing::scene_of(make_builtin_model("box"));
  const auto renderer = make_renderer(scene, {.threads = 1});
  Sensor sensor;
  sensor.optics = pinhole_from_fov(6, 5, 0.5);
  const Beams beams = make_beams(sensor);
  const Motion motion =
      static_motion(scene, look_at({5.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ()));
  for (const std::string& name : cloud_column_names()) {
    const std::vector<std::string> columns = {name};
    Frame frame;
    testing::simulate({scene, sensor, beams, motion, *renderer}, hit_columns_for(columns), frame);
    PointCloud cloud;
    make_point_cloud(frame, beams, scene, {.frame_id = beams.frame_id}, columns, cloud);
    EXPECT_EQ(static_cast<std::int64_t>(lockstep::bytes_of(cloud.columns.at(0)).size()),
              30 * point_bytes(columns))
        << name;
  }
}

TEST(ReplySize, CountsPointsAndHeadsOfAllClouds) {
  const std::vector<std::string> columns = {"xyz", "intensity"};
  EXPECT_EQ(reply_bytes(columns, 10, 3), 3 * (10 * 28 + 120));
  EXPECT_EQ(reply_bytes(columns, 4'000'000'000, 65536), 65536 * (4'000'000'000 * 28 + 120));
}

TEST(ReplySize, OfAnUnknownColumnIsRefused) {
  const std::vector<std::string> columns = {"nonsense"};
  EXPECT_THAT(error_text([&] { (void)point_bytes(columns); }), ::testing::HasSubstr("nonsense"));
}

}  // namespace
}  // namespace glidar::app
