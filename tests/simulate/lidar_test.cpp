// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/point_cloud.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <support/data.hpp>
#include <support/simulate.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

constexpr double kHalfSide_m = 2.0;

/// A closed room: the built-in box, 4 m wide, seen from its middle.
struct Room {
  Scene scene = testing::scene_of(make_builtin_model("box"));
  Frame frame;
  PointCloud cloud;

  explicit Room(const Sensor& sensor) {
    const double side_m = bounds(scene).sizes().x();
    scene.instances[0].scale = 2.0 * kHalfSide_m / side_m;
    const Beams beams = make_beams(sensor);
    const Motion motion = static_motion(scene, Pose::Identity());
    const auto renderer = make_renderer(scene, {.threads = 2});
    testing::simulate({scene, sensor, beams, motion, *renderer}, {}, frame);
    const std::vector<std::string> columns = {"xyz", "range", "ring", "time"};
    make_point_cloud(frame, beams, scene, {.frame_id = beams.frame_id}, columns, cloud);
    check(beams);
  }

  /// Every beam hits a wall, its point is on the wall, and its range has the correct offset.
  void check(const Beams& beams) const {
    const auto& xyz = std::get<std::vector<double>>(find_column(cloud, "xyz")->values);
    const auto& range = std::get<std::vector<double>>(find_column(cloud, "range")->values);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      if (std::isnan(beams.directions[i].x())) continue;  // a pixel that the lens does not image
      const Eigen::Vector3d p(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
      const Eigen::Vector3d o =
          beams.origins_m.empty() ? Eigen::Vector3d::Zero() : beams.origins_m[i];
      // single-precision vertices at 2 m; range and point are double
      const bool on_wall = std::abs(p.cwiseAbs().maxCoeff() - kHalfSide_m) < 1e-6;
      const bool counted = std::abs((p - o).norm() + beams.range_offset_m - range[i]) < 1e-12;
      if (!on_wall || !counted) ++wrong;
    }
    EXPECT_EQ(wrong, 0U);
  }
};

TEST(Lidar, EveryPresetCastsInARoom) {
  for (const SensorPreset& preset : sensor_presets()) {
    SCOPED_TRACE(preset.name);
    Sensor sensor = ground_truth_sensor(load_sensor_file(preset.reference));
    sensor.limits = {.along =
                         sensor.limits.along};  // the room may be too near or its corners too far
    const Room room(sensor);
    const auto& status = room.frame.status;
    EXPECT_EQ(std::count(status.begin(), status.end(), Status::hit) +
                  std::count(status.begin(), status.end(), Status::invalid_pixel),
              static_cast<std::ptrdiff_t>(status.size()));
  }
}

TEST(Lidar, CloudsHaveRingAndTime) {
  const Room room(ground_truth_sensor(load_sensor_file(find_sensor_file("VLP-16"))));
  const auto& ring = std::get<std::vector<std::uint16_t>>(find_column(room.cloud, "ring")->values);
  const auto& time = std::get<std::vector<std::uint32_t>>(find_column(room.cloud, "time")->values);
  EXPECT_EQ(room.cloud.rows, 16U);
  EXPECT_EQ(ring.front(), 15U);  // the highest beam is row 0
  EXPECT_EQ(ring.back(), 0U);
  EXPECT_EQ(time[0], 34'560U);  // laser 15
  EXPECT_EQ(time[1], 34'560U + 55'296U);
}

TEST(Lidar, LimitsApplyToTheReportedRange) {
  Sensor sensor = ground_truth_sensor(load_sensor_file(find_sensor_file("OS0-128")));
  sensor.limits = {.near_m = 0.0, .far_m = 2.5, .along = Limits::Along::range};
  const Beams beams = make_beams(sensor);
  Scene scene = testing::scene_of(make_builtin_model("sphere"));
  scene.instances[0].scale = 5.0 / bounds(scene).sizes().x();  // radius 2.5 m or a little less
  const Motion motion = static_motion(scene, Pose::Identity());
  const auto renderer = make_renderer(scene, {.threads = 2});
  Frame frame;
  testing::simulate({scene, sensor, beams, motion, *renderer}, {}, frame);
  for (std::size_t i = 0; i < frame.range_m.size(); ++i) {
    const double reported_m = frame.ground_truth.range_m[i] + beams.range_offset_m;
    EXPECT_EQ(frame.status[i], reported_m > 2.5 ? Status::too_far : Status::hit);
  }
}

TEST(Ouster, RangesInsideASphereMatchTheClosedForm) {
  const Sensor sensor = load_sensor_file(find_sensor_file("OS1-64"));
  const auto& spinning = std::get<Spinning>(sensor.optics);
  const Beams beams = make_beams(sensor);
  const Scene scene = testing::scene_of(make_builtin_model("sphere"));
  const double radius_m = 0.5 * bounds(scene).sizes().z();
  const Motion motion = static_motion(scene, Pose::Identity());
  const auto renderer = make_renderer(scene, {.threads = 2});
  Frame frame;
  testing::simulate({scene, sensor, beams, motion, *renderer}, {}, frame);
  double sum_m = 0.0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const SpinningChannel& channel = spinning.channels[beams.rings[i]];
    const double n = spinning.beam_origin_m;
    const double k = std::cos(channel.azimuth_offset_rad) * std::cos(channel.elevation_rad);
    // r = n (1 - k) + sqrt(R^2 - n^2 (1 - k^2)); the mesh is inside by up to its sagitta
    const double closed_m = n * (1 - k) + std::sqrt(radius_m * radius_m - n * n * (1 - k * k));
    const double found_m = frame.ground_truth.range_m[i] + beams.range_offset_m;
    ASSERT_LT(found_m, closed_m + 1e-7);
    ASSERT_GT(found_m, closed_m * (1 - 5e-3));
    sum_m += closed_m - found_m;
  }
  EXPECT_LT(sum_m / static_cast<double>(beams.size()), 2e-3 * radius_m);
}

}  // namespace
}  // namespace glidar
