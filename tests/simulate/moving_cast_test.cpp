// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/point_cloud.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/simulate/moving_cast.hpp>
#include <support/data.hpp>
#include <support/simulate.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace glidar {
namespace {

/// A camera whose pixels fire one after another, 1 ms apart.
struct Stage {
  Scene scene;
  Sensor sensor;
  Beams beams;
  Motion motion;
  std::unique_ptr<Renderer> renderer;

  explicit Stage(Scene what, const Pinhole& camera = pinhole_from_fov(24, 16, 0.6),
                 std::uint32_t interval_ns = 1'000'000)
      : scene(std::move(what)) {
    sensor.optics = camera;
    beams = make_beams(sensor);
    for (std::uint32_t i = 0; i < beams.size(); ++i) beams.times_ns.push_back(i * interval_ns);
    motion = static_motion(scene, look_at({0.4, -0.3, 5.0}, {0, 0, 0}, Eigen::Vector3d::UnitY()));
    renderer = make_renderer(scene, {.threads = 2});
  }
  testing::SimulationInputs inputs() { return {scene, sensor, beams, motion, *renderer}; }
  Frame shoot(std::int64_t stamp_ns = 0) {
    Frame frame;
    frame.stamp_ns = stamp_ns;
    testing::simulate(inputs(), kAllHitColumns, frame);
    return frame;
  }
};

Scene plane() {
  Scene scene = testing::scene_of(make_builtin_model("plane"));
  scene.instances[0].scale = 20.0;
  return scene;
}

/// A plane and two asteroids above it.
Scene plane_and_asteroids() {
  Scene scene = plane();
  add_model(scene, make_builtin_model("asteroid"));
  scene.instances[1].world_from_object.translation() << -0.8, 0.2, 1.5;
  scene.instances.push_back(scene.instances[1]);
  scene.instances[2].world_from_object.translation() << 0.9, -0.3, 2.0;
  scene.instances[2].id = 2;
  return scene;
}

std::int64_t time_of(const Frame& frame, const Beams& beams, std::size_t beam) {
  return frame.stamp_ns + beams.times_ns[beam];
}

/// Every beam cast alone, with everything at its pose at the beam's time.
void expect_as_if_cast_alone(Stage& stage, const Frame& frame) {
  constexpr double kRounding_m = 1e-13;  // poses are composed in another order
  for (std::size_t i = 0; i < stage.beams.size(); ++i) {
    const std::int64_t t_ns = time_of(frame, stage.beams, i);
    Beams one;
    one.rows = one.cols = 1;
    one.directions = {stage.beams.directions[i]};
    std::vector<Pose> poses;
    for (const Trajectory& path : stage.motion.world_from_instance) {
      poses.push_back(pose_at(path, t_ns));
    }
    Hits hits;
    stage.renderer->cast({.beams = one,
                          .world_from_sensor = pose_at(stage.motion.world_from_sensor, t_ns),
                          .world_from_instance = poses,
                          .hit_columns = kAllHitColumns},
                         hits);
    ASSERT_EQ(frame.ground_truth.instance[i], hits.instance[0]) << "beam " << i;
    if (hits.instance[0] == kInvalidId) continue;
    EXPECT_EQ(frame.ground_truth.primitive[i], hits.primitive[0]);
    EXPECT_NEAR(frame.ground_truth.range_m[i], hits.range_m[0], kRounding_m);
    EXPECT_NEAR(frame.ground_truth.depth_m[i], hits.depth_m[0], kRounding_m);
    EXPECT_LT((frame.ground_truth.normal[i] - hits.normal[0]).norm(), 1e-6F);
    EXPECT_LT((frame.ground_truth.shading_normal[i] - hits.shading_normal[0]).norm(), 1e-5F);
    EXPECT_NEAR(frame.ground_truth.cos_incidence[i], hits.cos_incidence[0], 1e-6F);
    EXPECT_NEAR(frame.ground_truth.cos_shading[i], hits.cos_shading[0], 1e-5F);
    EXPECT_LT((frame.ground_truth.object_point_m[i] - hits.object_point_m[0]).norm(), 1e-12);
  }
}

TEST(MovingCast, DeskewedPointsOfAPlaneAreOnThePlane) {
  Stage stage(plane());
  stage.motion.world_from_sensor = ConstantTwist{.pose = pose_at(stage.motion.world_from_sensor, 0),
                                                 .angular_rad_s = {0.3, -0.4, 0.8},
                                                 .linear_m_s = {1.0, -2.0, 0.5}};
  const Frame frame = stage.shoot();
  PointCloud raw;
  PointCloud deskewed;
  const std::vector<std::string> columns = {"xyz", "normal"};
  const OutputFrame world{.frame_id = "world", .cloud_from_sensor = frame.world_from_sensor};
  OutputFrame deskewed_world = world;
  deskewed_world.deskew = true;
  make_point_cloud(frame, stage.beams, stage.scene, world, columns, raw);
  make_point_cloud(frame, stage.beams, stage.scene, deskewed_world, columns, deskewed);
  double furthest_raw = 0.0;
  for (std::size_t i = 0; i < stage.beams.size(); ++i) {
    ASSERT_EQ(frame.status[i], Status::hit);
    const auto& xyz = std::get<std::vector<double>>(deskewed.columns[0].values);
    const auto& normals = std::get<std::vector<float>>(deskewed.columns[1].values);
    EXPECT_NEAR(xyz[3 * i + 2], 0.0, 1e-12);
    EXPECT_NEAR(normals[3 * i + 2], 1.0F, 1e-6F);
    furthest_raw = std::max(
        furthest_raw, std::abs(std::get<std::vector<double>>(raw.columns[0].values)[3 * i + 2]));
  }
  EXPECT_GT(furthest_raw, 0.1);  // the error that deskewing corrects
}

TEST(MovingCast, HitsAnApproachingPlaneAtTheFiringTime) {
  Stage stage(plane());
  constexpr double kSpeed_m_s = 2.0;
  stage.motion.world_from_instance[0] =
      ConstantTwist{.linear_m_s = {0.0, 0.0, kSpeed_m_s}, .frame = TwistFrame::world};
  stage.motion.world_from_sensor =
      ConstantPose{look_at({0, 0, 5.0}, {0, 0, 0}, Eigen::Vector3d::UnitY())};
  const Frame frame = stage.shoot(250'000'000);
  for (std::size_t i = 0; i < stage.beams.size(); ++i) {
    const double t_s = static_cast<double>(time_of(frame, stage.beams, i)) * 1e-9;
    EXPECT_NEAR(frame.ground_truth.depth_m[i], 5.0 - kSpeed_m_s * t_s, 1e-13);
  }
  EXPECT_TRUE(frame.deskewed.directions.empty()) << "the sensor is stationary";
}

TEST(MovingCast, HitsEveryBodyAtTheFiringTime) {
  Stage stage(plane_and_asteroids());
  stage.motion.world_from_sensor = ConstantTwist{.pose = pose_at(stage.motion.world_from_sensor, 0),
                                                 .angular_rad_s = {0.05, -0.04, 0.1},
                                                 .linear_m_s = {0.2, 0.1, -0.3}};
  for (const std::size_t i : {std::size_t{1}, std::size_t{2}}) {
    stage.motion.world_from_instance[i] =
        ConstantTwist{.pose = stage.scene.instances[i].world_from_object,
                      .angular_rad_s = {1.0, 2.0, -1.5},
                      .linear_m_s = {0.5, 0.0, -0.2}};
  }
  const Frame frame = stage.shoot(10'000'000);
  expect_as_if_cast_alone(stage, frame);
  std::array<std::size_t, 3> seen{};
  for (const std::uint32_t instance : frame.ground_truth.instance) {
    if (instance != kInvalidId) ++seen[instance];
  }
  EXPECT_GT(seen[0], 20U);
  EXPECT_GT(seen[1], 20U);
  EXPECT_GT(seen[2], 20U);
}

TEST(MovingCast, HitsASingleMovingBody) {
  Stage stage(testing::scene_of(make_builtin_model("asteroid")));
  stage.motion.world_from_instance[0] =
      ConstantTwist{.angular_rad_s = {2.0, -1.0, 3.0}, .linear_m_s = {0.3, 0.1, 0.0}};
  const Frame frame = stage.shoot();
  expect_as_if_cast_alone(stage, frame);
}

/// Poses around a start, every 20 ms.
TimedPoses wobbling(const Pose& start, Interpolation interpolation) {
  std::vector<TimedPose> poses;
  for (int i = 0; i < 12; ++i) {
    const double t = 0.3 * i;
    const Eigen::AngleAxisd turn(0.2 * std::sin(t), Eigen::Vector3d(1, t, -1).normalized());
    poses.push_back({.t_ns = i * 20'000'000LL,
                     .position_m = start.translation() +
                                   Eigen::Vector3d(0.3 * std::sin(t), 0.2 * std::cos(t), 0.05 * t),
                     .orientation = Eigen::Quaterniond(start.linear() * turn)});
  }
  return TimedPoses(std::move(poses), interpolation);
}

Trajectory motion_of_kind(std::size_t kind, const Pose& start) {
  const Eigen::Vector3d rate_rad_s(3.0, -2.0, 5.0);
  const Eigen::Vector3d speed_m_s(1.5, -2.0, 0.7);
  switch (kind % 6) {
    case 0:
      return ConstantPose{start};
    case 1:
      return Spin{.pose = start, .rate_rad_s = rate_rad_s};
    case 2:
      return wobbling(start, Interpolation::linear);
    case 3:
      return wobbling(start, Interpolation::spline);
    case 4:
      return TorqueFreeRotation({.moments_kg_m2 = {1.0, 2.0, 2.5},
                                 .rate_rad_s = rate_rad_s,
                                 .world_from_body = start,
                                 .velocity_m_s = speed_m_s});
    default:
      return ConstantTwist{.pose = start, .angular_rad_s = rate_rad_s, .linear_m_s = speed_m_s};
  }
}

/// Bodies of six kinds of motion and of sizes from 0.02 to 0.6 m above a plane. Half of them are
/// far from the origin of their own frame.
Scene crowd_scene() {
  Scene scene = plane();
  add_model(scene, make_builtin_model("asteroid"));
  Model shifted = make_builtin_model("box");
  shifted.mesh.origin_m += Eigen::Vector3d(3.0, -1.0, 2.0);
  add_model(scene, std::move(shifted));
  scene.instances.resize(1);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place_m(-1.5, 1.5);
  std::uniform_real_distribution<double> digits(-1.7, -0.2);
  for (std::uint32_t i = 1; i <= 60; ++i) {
    Instance instance;
    instance.name = "body" + std::to_string(i);
    instance.mesh = 1 + i % 2;
    instance.id = i;
    instance.scale = std::pow(10.0, digits(random));
    instance.materials = {0};
    instance.world_from_object.linear() =
        Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d(1, i, 2).normalized()).toRotationMatrix();
    instance.world_from_object.translation() << place_m(random), place_m(random),
        1.5 + 0.7 * place_m(random);
    scene.instances.push_back(instance);
  }
  return scene;
}

struct Crowd : Stage {
  Crowd() : Stage(crowd_scene(), pinhole_from_fov(60, 40, 0.7), 50'000) {
    motion.world_from_sensor = ConstantTwist{.pose = pose_at(motion.world_from_sensor, 0),
                                             .angular_rad_s = {0.5, -0.4, 1.0},
                                             .linear_m_s = {2.0, 1.0, -3.0}};
    for (std::size_t i = 1; i < scene.instances.size(); ++i) {
      motion.world_from_instance[i] = motion_of_kind(i, scene.instances[i].world_from_object);
    }
  }
};

TEST(MovingCast, HitsManyBodiesOfAllKindsOfMotion) {
  Crowd stage;
  const Frame frame = stage.shoot(20'000'000);
  expect_as_if_cast_alone(stage, frame);
  const std::set<std::uint32_t> seen(frame.ground_truth.instance.begin(),
                                     frame.ground_truth.instance.end());
  EXPECT_GT(seen.size(), 30U);
}

TEST(MovingCast, HitsManyBodiesWithBeamsInOneRow) {
  Crowd stage;
  stage.beams.cols *= stage.beams.rows;
  stage.beams.rows = 1;
  stage.beams.pinhole.reset();
  expect_as_if_cast_alone(stage, stage.shoot(20'000'000));
}

TEST(MovingCast, CountsTheBeamsThatWouldHitEachBodyAlone) {
  Crowd stage;
  const TimedScene timed{*stage.renderer, stage.scene, stage.motion, 20'000'000};
  Frame poses;
  poses.stamp_ns = timed.stamp_ns;
  sample_poses(stage.motion, poses);
  CastRequest request{.beams = stage.beams,
                      .world_from_sensor = poses.world_from_sensor,
                      .world_from_instance = poses.world_from_instance};
  MovingCastWorkspace workspace;
  std::vector<std::uint32_t> counts(stage.scene.instances.size(), 0);
  count_body_hits(timed, request, workspace, counts);
  std::vector<std::uint8_t> alone(counts.size(), 0);
  std::uint32_t most = 0;
  for (std::size_t i = 1; i < counts.size(); ++i) {
    alone.assign(counts.size(), 0);
    alone[i] = 1;
    request.instance_enabled = alone;
    Hits hits;
    cast_moving(timed, request, workspace, hits);
    const auto expected = std::count(hits.instance.begin(), hits.instance.end(), i);
    const bool moves = !is_static(stage.motion.world_from_instance[i]);
    EXPECT_EQ(counts[i], moves ? expected : 0) << "instance " << i;
    most = std::max(most, counts[i]);
  }
  EXPECT_GT(most, 20U);
}

TEST(MovingCast, ABodyThatNoBeamMeetsChangesNothing) {
  Stage stage(plane_and_asteroids());
  const Frame at_rest = stage.shoot();
  add_model(stage.scene, make_builtin_model("box"));
  Stage with_body(std::move(stage.scene));
  Pose behind = Pose::Identity();
  behind.translation() << 0.0, 0.0, 20.0;
  with_body.motion.world_from_instance[3] = ConstantTwist{.pose = behind, .linear_m_s = {1, 0, 0}};
  std::vector<double> reported;
  testing::SimulationInputs inputs = with_body.inputs();
  inputs.progress = [&](double fraction) { reported.push_back(fraction); };
  Frame frame;
  testing::simulate(inputs, kAllHitColumns, frame);
  EXPECT_EQ(frame.ground_truth.instance, at_rest.ground_truth.instance);
  constexpr double kRounding_m = 1e-14;  // directions are normalised once more
  for (std::size_t i = 0; i < frame.ground_truth.range_m.size(); ++i) {
    EXPECT_NEAR(frame.ground_truth.range_m[i], at_rest.ground_truth.range_m[i], kRounding_m);
  }
  ASSERT_FALSE(reported.empty());
  EXPECT_DOUBLE_EQ(reported.back(), 1.0);
}

TEST(MovingCast, BodiesAroundTheSensorAreCastAFewAtATime) {
  Scene scene = plane();
  add_model(scene, make_builtin_model("box"));
  const Instance box = scene.instances[1];
  constexpr int kBodies = 60;
  for (int i = 1; i < kBodies; ++i) {
    scene.instances.push_back(box);
    scene.instances.back().id = static_cast<std::uint32_t>(1 + i);
  }
  Stage stage(std::move(scene));
  for (std::size_t i = 1; i < stage.scene.instances.size(); ++i) {
    stage.scene.instances[i].scale = 40.0 - 0.4 * static_cast<double>(i);
    stage.motion.world_from_instance[i] =
        ConstantTwist{.angular_rad_s = {0.1, 0.2, 0.3}, .linear_m_s = {1.0, 0.0, 2.0}};
  }
  const Frame frame = stage.shoot();
  expect_as_if_cast_alone(stage, frame);
  const TimedScene timed{*stage.renderer, stage.scene, stage.motion, 0};
  const CastRequest request{.beams = stage.beams,
                            .world_from_sensor = frame.world_from_sensor,
                            .world_from_instance = frame.world_from_instance};
  MovingCastWorkspace workspace;
  Hits hits;
  cast_moving(timed, request, workspace, hits);
  EXPECT_EQ(hits.instance, frame.ground_truth.instance);
  EXPECT_LT(workspace.targets.capacity(), kBodies * stage.beams.size() / 2);
}

TEST(MovingCast, IsExactFarFromTheWorldsOrigin) {
  Stage stage(plane());
  const Eigen::Vector3d far(1e6, -2e6, 5e5);
  Pose pose = pose_at(stage.motion.world_from_sensor, 0);
  pose.translation() += far;
  stage.scene.instances[0].world_from_object.translation() += far;
  stage.motion.world_from_instance[0] = ConstantPose{stage.scene.instances[0].world_from_object};
  stage.motion.world_from_sensor = ConstantTwist{.pose = pose, .linear_m_s = {0.0, 0.0, 1.0}};
  const Frame frame = stage.shoot();
  for (std::size_t i = 0; i < stage.beams.size(); ++i) {
    ASSERT_EQ(frame.status[i], Status::hit);
    const Eigen::Vector3d point =
        frame.deskewed.origins_m[i] + frame.range_m[i] * frame.deskewed.directions[i];
    // A pose at 2e6 m is itself rounded to 2.3e-10 m in double.
    EXPECT_NEAR((pose * point - far).z(), 0.0, 1e-9);
  }
}

TEST(MovingCast, ReportsProgressOverStaticAndMovingBodies) {
  Stage stage(plane_and_asteroids());
  for (const std::size_t i : {std::size_t{1}, std::size_t{2}}) {
    stage.motion.world_from_instance[i] = ConstantTwist{
        .pose = stage.scene.instances[i].world_from_object, .angular_rad_s = {1.0, 2.0, -1.5}};
  }
  std::vector<double> reported;
  testing::SimulationInputs inputs = stage.inputs();
  inputs.progress = [&](double fraction) { reported.push_back(fraction); };
  Frame frame;
  testing::simulate(inputs, kAllHitColumns, frame);
  ASSERT_GE(reported.size(), 2U);  // what is static and what moves, at least at their ends
  EXPECT_TRUE(std::is_sorted(reported.begin(), reported.end()));
  EXPECT_GE(reported.front(), 0.0);
  EXPECT_LE(reported.front(), 0.5);
  EXPECT_DOUBLE_EQ(reported.back(), 1.0);
}

TEST(MovingCast, AllocatesNothingInTheSteadyState) {
  Stage stage(plane());
  stage.motion.world_from_sensor =
      ConstantTwist{.pose = pose_at(stage.motion.world_from_sensor, 0), .linear_m_s = {1, 0, 0}};
  Simulator simulator(stage.scene, stage.sensor, *stage.renderer);
  Frame frame;
  Simulation simulation = simulator.prepare(stage.beams, stage.motion, kAllHitColumns, frame, {});
  simulate({&simulation, 1});
  const void* const moved = simulation.workspace.moving_cast.beams.directions.data();
  const void* const deskewed = frame.deskewed.directions.data();
  simulate({&simulation, 1});
  EXPECT_EQ(simulation.workspace.moving_cast.beams.directions.data(), moved);
  EXPECT_EQ(frame.deskewed.directions.data(), deskewed);
}

}  // namespace
}  // namespace glidar
