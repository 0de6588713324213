// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/object_boxes.hpp>

#include <glidar/io/model/builtin_models.hpp>
#include <glidar/simulate/simulator.hpp>
#include <support/data.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace glidar {
namespace {

/// A ground without a class, and asteroids and a box with one, of which some hide others.
Scene crowded_scene() {
  Scene scene = testing::scene_of(make_builtin_model("plane"));
  scene.class_names = {"unlabelled", "rock", "crate"};
  scene.instances[0].scale = 20.0;
  scene.instances[0].world_from_object.translation().z() = -1.0;
  add_model(scene, make_builtin_model("asteroid"));
  scene.instances[1].class_id = 1;
  scene.instances[1].world_from_object.translation() << 4.0, 0.2, 0.0;
  for (const double x : {7.0, 10.0}) {
    scene.instances.push_back(scene.instances[1]);
    scene.instances.back().world_from_object.translation().x() = x;
    scene.instances.back().id = static_cast<std::uint32_t>(scene.instances.size());
  }
  add_model(scene, make_builtin_model("box"));
  Instance& crate = scene.instances.back();
  crate.class_id = 2;
  crate.scale = 1.5;
  crate.world_from_object = make_pose({5.0, 1.5, 0.3}, Eigen::Quaterniond(0.9, 0.1, 0.2, 0.4));
  return scene;
}

Sensor camera() {
  Sensor sensor;
  sensor.optics = pinhole_from_fov(48, 32, 1.0);
  return sensor;
}

/// From the scene's origin along its x axis, for cameras.
Pose ahead() {
  return look_at({0.0, 0.0, 0.5}, {5.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
}

/// A scene, a sensor and a motion in it.
struct Crowd {
  Scene scene = crowded_scene();
  std::shared_ptr<const BeamCache> beams;
  Motion motion;
  std::unique_ptr<Renderer> renderer;
  std::unique_ptr<Renderer> reference;  ///< for single beams

  explicit Crowd(const Sensor& sensor, const std::string& kind = "rays")
      : beams(std::make_shared<const BeamCache>(sensor)),
        motion(static_motion(scene, ahead())),
        renderer(make_renderer(scene, {.kind = kind, .threads = 2})),
        reference(make_renderer(scene, {.kind = "rays", .threads = 1})) {}

  /// The same with beams that fire one after another.
  void fire_one_by_one() {
    Beams all = *beams->beams(0);
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      all.times_ns.push_back(100'000U * (i % static_cast<std::uint32_t>(all.firings())));
    }
    beams = std::make_shared<const BeamCache>(beams->sensor(), all);
  }
  [[nodiscard]] Frame shoot() const {
    Frame frame;
    frame.stamp_ns = 20'000'000;
    Simulator(scene, beams, *renderer).simulate(motion, {.boxes = true}, frame);
    return frame;
  }
};

/// The instance that one beam hits, with everything at its pose at a time; `only` alone, or all.
std::uint32_t cast_one(const Crowd& crowd, std::size_t beam, std::int64_t t_ns,
                       std::uint32_t only) {
  const Beams& all = *crowd.beams->beams(0);
  Beams one;
  one.rows = one.cols = 1;
  one.directions = {all.directions[beam]};
  if (!all.origins_m.empty()) one.origins_m = {all.origins_m[beam]};
  std::vector<Pose> poses;
  for (const Trajectory& path : crowd.motion.world_from_instance)
    poses.push_back(pose_at(path, t_ns));
  std::vector<std::uint8_t> enabled(crowd.scene.instances.size(), only == kInvalidId ? 1 : 0);
  if (only != kInvalidId) enabled[only] = 1;
  Hits hits;
  crowd.reference->cast({.beams = one,
                         .world_from_sensor = pose_at(crowd.motion.world_from_sensor, t_ns),
                         .world_from_instance = poses,
                         .instance_enabled = enabled},
                        hits);
  return hits.instance[0];
}

/// Compares the counts of all boxes with casts of single beams into single objects.
void expect_counts_of_single_casts(const Crowd& crowd, const Frame& frame) {
  const Beams& all = *crowd.beams->beams(0);
  std::vector<std::uint32_t> alone(crowd.scene.instances.size());
  std::vector<std::uint32_t> visible(crowd.scene.instances.size());
  for (std::size_t i = 0; i < all.firings(); ++i) {
    const std::int64_t t_ns = frame.stamp_ns + (all.times_ns.empty() ? 0 : all.times_ns[i]);
    const std::uint32_t first = cast_one(crowd, i, t_ns, kInvalidId);
    if (first != kInvalidId) ++visible[first];
    for (const ObjectBox& box : frame.boxes) {
      if (cast_one(crowd, i, t_ns, box.instance) == box.instance) ++alone[box.instance];
    }
  }
  ASSERT_EQ(frame.boxes.size(), 4U);
  bool is_any_hidden = false;
  for (const ObjectBox& box : frame.boxes) {
    EXPECT_EQ(box.beams, alone[box.instance]) << "instance " << box.instance;
    EXPECT_EQ(box.visible_beams, visible[box.instance]) << "instance " << box.instance;
    is_any_hidden = is_any_hidden || box.visible_beams < box.beams;
  }
  EXPECT_TRUE(is_any_hidden);
}

TEST(ObjectBoxes, CountsAreThoseOfBeamsThatAreCastAlone) {
  for (const char* kind : {"rays", "raster", "auto"}) {
    const Crowd crowd(camera(), kind);
    expect_counts_of_single_casts(crowd, crowd.shoot());
  }
}

TEST(ObjectBoxes, CountsOfAMovingSensorAndObjectAreThoseAtTheFiringTimes) {
  Crowd crowd(camera());
  crowd.fire_one_by_one();
  crowd.motion.world_from_sensor = ConstantTwist{
      .pose = ahead(), .angular_rad_s = {0.3, -0.4, 0.8}, .linear_m_s = {1.0, -2.0, 0.5}};
  crowd.motion.world_from_instance[2] =
      ConstantTwist{.pose = crowd.scene.instances[2].world_from_object,
                    .angular_rad_s = {0.0, 2.0, 1.0},
                    .linear_m_s = {0.0, 8.0, 1.0}};
  expect_counts_of_single_casts(crowd, crowd.shoot());
}

TEST(ObjectBoxes, PulsesWithSeveralReturnsCountOnceEachWhereTheirAxisHits) {
  Sensor sensor = camera();
  sensor.wavelength_m = 905e-9;
  sensor.lidar_equation = LidarEquation{.noise_sigma = 0.1};
  sensor.footprint = Footprint{.divergence_x_rad = 2e-2, .divergence_y_rad = 2e-2};
  sensor.receiver.returns = {{Return::Order::strongest, 0}, {Return::Order::farthest, 0}};
  sensor.noise = {PointingJitter{.sigma_azimuth_rad = 1e-2}};
  const Crowd crowd(sensor);
  expect_counts_of_single_casts(crowd, crowd.shoot());
}

TEST(ObjectBoxes, AreTightOrientedAndMoveWithTheirObject) {
  Crowd crowd(camera());
  const Pose& at = crowd.scene.instances[4].world_from_object;
  const Eigen::Vector3d angular(0.0, 0.0, 2.0);
  const Eigen::Vector3d linear(3.0, 0.0, 0.0);
  crowd.motion.world_from_instance[4] =
      ConstantTwist{.pose = at, .angular_rad_s = angular, .linear_m_s = linear};
  const Frame frame = crowd.shoot();
  const ObjectBox& crate = frame.boxes.back();
  ASSERT_EQ(crate.instance, 4U);
  const Mesh& mesh = crowd.scene.meshes[crowd.scene.instances[4].mesh];
  const Pose sensor_from_object = frame.world_from_sensor.inverse() * frame.world_from_instance[4];
  Eigen::AlignedBox3d inside;
  for (std::uint32_t i = 0; i < mesh.positions_m.size(); ++i) {
    inside.extend(crate.sensor_from_box.inverse() *
                  (sensor_from_object * (1.5 * vertex_m(mesh, i))));
  }
  EXPECT_LT((inside.max() - 0.5 * crate.size_m).norm(), 1e-12);
  EXPECT_LT((inside.min() + 0.5 * crate.size_m).norm(), 1e-12);
  EXPECT_LT((crate.sensor_from_box.linear() - sensor_from_object.linear()).norm(), 1e-12);
  // the difference quotient of the centre in the world
  constexpr std::int64_t kStep_ns = 1000;
  const auto centre = [&](std::int64_t t_ns) -> Eigen::Vector3d {
    return pose_at(crowd.motion.world_from_instance[4], t_ns) *
           (sensor_from_object.inverse() * crate.sensor_from_box.translation());
  };
  const Eigen::Vector3d velocity = (centre(frame.stamp_ns + kStep_ns) - centre(frame.stamp_ns)) /
                                   (1e-9 * static_cast<double>(kStep_ns));
  EXPECT_LT((frame.world_from_sensor.linear() * crate.velocity_m_s - velocity).norm(), 1e-4);
  EXPECT_GT(velocity.norm(), 2.0);
  EXPECT_EQ(frame.boxes.front().velocity_m_s, Eigen::Vector3d::Zero());
}

TEST(ObjectBoxes, PointsAreTheReturnsOfTheObject) {
  Sensor sensor = camera();
  sensor.limits.far_m = 6.5;  // behind the first asteroid
  const Crowd crowd(sensor);
  const Frame frame = crowd.shoot();
  for (const ObjectBox& box : frame.boxes) {
    std::uint32_t points = 0;
    for (std::size_t i = 0; i < frame.status.size(); ++i) {
      const bool is_hit = frame.status[i] == Status::hit;
      if (is_hit && frame.ground_truth.instance[i] == box.instance) ++points;
    }
    EXPECT_EQ(box.points, points);
  }
  EXPECT_EQ(frame.boxes[0].points, frame.boxes[0].visible_beams);
  EXPECT_EQ(frame.boxes[2].points, 0U);
  EXPECT_GT(frame.boxes[2].beams, 0U) << "limits of range do not matter";
}

TEST(ObjectBoxes, AreThereOnRequestAndForObjectsWithAClass) {
  const Crowd crowd(camera());
  Frame frame;
  Simulator simulator(crowd.scene, crowd.beams, *crowd.renderer);
  simulator.simulate(crowd.motion, {.boxes = true}, frame);
  EXPECT_EQ(frame.boxes.size(), 4U);
  EXPECT_EQ(simulator.find_boxes(crowd.motion, frame, BoxSelection::with_class).size(), 4U);
  const auto all = simulator.find_boxes(crowd.motion, frame, BoxSelection::all);
  ASSERT_EQ(all.size(), 5U);
  EXPECT_EQ(all[0].instance, 0U);
  EXPECT_EQ(all[3].beams, frame.boxes[2].beams);
  simulator.simulate(crowd.motion, {}, frame);
  EXPECT_TRUE(frame.boxes.empty());
}

TEST(ObjectBoxes, OcclusionIsUnknownWhereNoBeamWouldHit) {
  EXPECT_TRUE(std::isnan(occlusion({})));
  EXPECT_EQ(occlusion({.beams = 8, .visible_beams = 6}), 0.25);
}

TEST(ObjectBoxes, ClassesAreThoseOfTheScene) {
  const Crowd crowd(camera());
  Simulator simulator(crowd.scene, crowd.beams, *crowd.renderer);
  EXPECT_THROW(simulator.set_boxed_classes({true, true}), Error);
  EXPECT_THROW(simulator.set_boxed_classes({true, true, true, true}), Error);
  simulator.set_boxed_classes({false, false, true});
  Frame frame;
  simulator.simulate(crowd.motion, {.boxes = true}, frame);
  EXPECT_EQ(frame.boxes.size(), 1U);
  simulator.set_boxed_classes({});
  simulator.simulate(crowd.motion, {.boxes = true}, frame);
  EXPECT_EQ(frame.boxes.size(), 4U);
}

}  // namespace
}  // namespace glidar
