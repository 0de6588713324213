// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <support/data.hpp>
#include <support/error_text.hpp>
#include <support/simulate.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace glidar {
namespace {

constexpr std::int64_t kStamp_ns = 250'000'000;

/// A camera whose pixels fire 1 ms apart flies past a tumbling asteroid of scale 2 and a sphere at
/// rest.
struct Stage {
  Scene scene = testing::scene_of(make_builtin_model("asteroid"));
  Sensor sensor;
  Beams beams;
  Motion motion;
  std::unique_ptr<Renderer> renderer;
  Frame frame;

  Stage() {
    add_model(scene, make_builtin_model("sphere"));
    scene.instances[0].scale = 2.0;
    scene.instances[1].world_from_object.translation() << 1.5, 0.4, 0.5;
    sensor.optics = pinhole_from_fov(24, 16, 0.6);
    beams = make_beams(sensor);
    for (std::uint32_t i = 0; i < beams.size(); ++i) beams.times_ns.push_back(i * 1'000'000U);
    const Pose start = look_at({0.4, -0.3, 8.0}, {0, 0, 0}, Eigen::Vector3d::UnitY());
    motion = static_motion(scene, start);
    motion.world_from_sensor = ConstantTwist{
        .pose = start, .angular_rad_s = {0.1, -0.2, 0.3}, .linear_m_s = {0.3, 0.2, 0.4}};
    motion.world_from_instance[0] =
        ConstantTwist{.angular_rad_s = {1.0, -0.5, 2.0}, .linear_m_s = {0.3, 0.1, 0.0}};
    renderer = make_renderer(scene, {.threads = 2});
    frame.stamp_ns = kStamp_ns;
  }

  PointCloud shoot(const std::vector<std::string>& columns) {
    testing::simulate({scene, sensor, beams, motion, *renderer}, hit_columns_for(columns), frame);
    PointCloud cloud;
    make_point_cloud(frame, beams, scene, {beams.frame_id}, columns, cloud);
    return cloud;
  }

  /// The poses that poses_at gives of one trajectory at all beams' times.
  [[nodiscard]] std::vector<Pose> poses(const Trajectory& trajectory) const {
    std::vector<std::int64_t> times_ns;
    for (const std::uint32_t t_ns : beams.times_ns) times_ns.push_back(kStamp_ns + t_ns);
    std::vector<Pose> all(times_ns.size());
    poses_at(trajectory, times_ns, all);
    return all;
  }
};

const double* row_of(const PointCloud& cloud, const char* name, std::size_t point) {
  const Column& column = *find_column(cloud, name);
  return std::get<std::vector<double>>(column.values).data() + point * column.components.size();
}

Pose pose_of(const double* numbers) {
  const Eigen::Quaterniond q(numbers[3], numbers[4], numbers[5], numbers[6]);
  EXPECT_NEAR(q.norm(), 1.0, 1e-15);
  EXPECT_GE(q.w(), 0.0);
  return make_pose({numbers[0], numbers[1], numbers[2]}, q);
}

TEST(BeamPoses, AreThoseAtTheFiringTimes) {
  Stage stage;
  const PointCloud cloud = stage.shoot({"stamp", "sensor_pose", "object_pose"});
  const auto& stamps = std::get<std::vector<std::int64_t>>(find_column(cloud, "stamp")->values);
  const std::vector<Pose> sensor = stage.poses(stage.motion.world_from_sensor);
  const std::vector<std::vector<Pose>> objects = {stage.poses(stage.motion.world_from_instance[0]),
                                                  stage.poses(stage.motion.world_from_instance[1])};
  std::array<int, 3> seen{};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_EQ(stamps[i], kStamp_ns + static_cast<std::int64_t>(i) * 1'000'000);
    EXPECT_TRUE(pose_of(row_of(cloud, "sensor_pose", i)).isApprox(sensor[i], 1e-14));
    const std::uint32_t hit = stage.frame.ground_truth.instance[i];
    const double* object = row_of(cloud, "object_pose", i);
    ++seen[std::min(hit, 2U)];
    if (hit == kInvalidId) {
      EXPECT_TRUE(std::all_of(object, object + 7, [](double x) { return std::isnan(x); }));
    } else {
      EXPECT_TRUE(pose_of(object).isApprox(objects[hit][i], 1e-14));
    }
  }
  EXPECT_THAT(seen, ::testing::Each(::testing::Gt(20)));
}

TEST(BeamPoses, MapTheBeamToTheObjectPoint) {
  Stage stage;
  const PointCloud cloud = stage.shoot({"sensor_pose", "object_pose", "object_point", "range"});
  int hits = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::uint32_t hit = stage.frame.ground_truth.instance[i];
    if (hit == kInvalidId) continue;
    const Eigen::Vector3d object_point(row_of(cloud, "object_point", i));
    const Eigen::Vector3d by_object = pose_of(row_of(cloud, "object_pose", i)) *
                                      (stage.scene.instances[hit].scale * object_point);
    const Eigen::Vector3d by_sensor = pose_of(row_of(cloud, "sensor_pose", i)) *
                                      (*row_of(cloud, "range", i) * stage.beams.directions[i]);
    EXPECT_LT((by_object - by_sensor).norm(), 1e-12);
    ++hits;
  }
  EXPECT_GT(hits, 40);
}

TEST(BeamPoses, OfAStaticSceneAreThoseOfTheFrame) {
  Stage stage;
  stage.motion =
      static_motion(stage.scene, look_at({0.4, -0.3, 8.0}, {0, 0, 0}, Eigen::Vector3d::UnitY()));
  stage.beams.times_ns.clear();
  const PointCloud cloud = stage.shoot({"stamp", "sensor_pose", "object_pose"});
  EXPECT_THAT(std::get<std::vector<std::int64_t>>(find_column(cloud, "stamp")->values),
              ::testing::Each(kStamp_ns));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_TRUE(
        pose_of(row_of(cloud, "sensor_pose", i)).isApprox(stage.frame.world_from_sensor, 1e-14));
    const std::uint32_t hit = stage.frame.ground_truth.instance[i];
    if (hit == kInvalidId) continue;
    EXPECT_TRUE(pose_of(row_of(cloud, "object_pose", i))
                    .isApprox(stage.frame.world_from_instance[hit], 1e-14));
  }
}

TEST(BeamPoses, AreStoredOnlyWhenRequested) {
  Stage stage;
  stage.shoot({"sensor_pose"});
  EXPECT_EQ(stage.frame.beam_poses.world_from_sensor.size(), stage.beams.size());
  stage.shoot({"xyz", "stamp"});
  EXPECT_TRUE(stage.frame.beam_poses.world_from_sensor.empty());
  EXPECT_TRUE(stage.frame.beam_poses.world_from_object.empty());
  PointCloud cloud;
  const std::vector<std::string> columns = {"object_pose"};
  EXPECT_THAT(error_text([&] {
                make_point_cloud(stage.frame, stage.beams, stage.scene, {stage.beams.frame_id},
                                 columns, cloud);
              }),
              ::testing::HasSubstr("the frame was cast without it"));
}

}  // namespace
}  // namespace glidar
