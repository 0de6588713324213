// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <render/renderer_suite.hpp>

#include <glidar/render/resolver.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

// Every renderer reports the lowest (instance, triangle) of coincident surfaces.

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;
using testing::turned;

class CoincidentSurfaces : public testing::RendererSuite {
 protected:
  static std::size_t count(const Hits& hits, std::uint32_t instance) {
    return static_cast<std::size_t>(
        std::count(hits.instance.begin(), hits.instance.end(), instance));
  }

  /// A second instance, with its own mesh.
  static Instance& add(Scene& scene, Mesh mesh) {
    Instance instance = scene.instances[0];
    instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
    scene.sources.emplace_back();
    scene.instances.push_back(instance);
    return scene.instances.back();
  }

  /// Expects that every hit belongs to instance 0.
  static void expect_first_only(const Scene& scene, std::size_t least) {
    for (const double distance_m : {4.0, 400.0}) {
      const Eigen::Vector3d object = scene.instances[0].world_from_object.translation();
      const Pose pose = look_at(object + distance_m * Eigen::Vector3d(0.6, -0.3, 0.74), object,
                                Eigen::Vector3d::UnitZ());
      const Hits hits = cast(scene, camera_beams(120, 100, 30.0 * distance_m), pose);
      EXPECT_EQ(count(hits, 1), 0U) << "at " << distance_m << " m";
      EXPECT_GT(count(hits, 0), least) << "at " << distance_m << " m";
    }
  }
};

TEST_P(CoincidentSurfaces, TheFirstOfIdenticalInstancesIsReported) {
  Scene scene = builtin_scene("asteroid");
  scene.instances[0].world_from_object = turned(0.7, {1.0, 2.0, 3.0}, {0.4, -0.2, 3.0});
  scene.instances.push_back(scene.instances[0]);
  expect_first_only(scene, 1000);
}

TEST_P(CoincidentSurfaces, IdenticalInstancesEqualASingleInstance) {
  Scene scene = builtin_scene("sphere");
  scene.instances[0].world_from_object = turned(0.7, {1.0, 2.0, 3.0}, {0.1, -0.2, 5.0});
  const Beams beams = camera_beams(150, 120, 200.0);
  const Hits alone = cast(scene, beams, Pose::Identity());
  scene.instances.push_back(scene.instances[0]);
  scene.instances.push_back(scene.instances[0]);
  const Hits all = cast(scene, beams, Pose::Identity());
  EXPECT_EQ(all.instance, alone.instance);
  EXPECT_EQ(all.primitive, alone.primitive);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (alone.instance[i] == kInvalidId) continue;
    EXPECT_EQ(all.range_m[i], alone.range_m[i]) << i;
  }
}

TEST_P(CoincidentSurfaces, TheNextInstanceIsReportedIfTheFirstIsDisabled) {
  Scene scene = builtin_scene("sphere");
  scene.instances.push_back(scene.instances[0]);
  scene.instances.push_back(scene.instances[0]);
  const Beams beams = camera_beams(40, 40, 40.0);
  const std::vector<std::uint8_t> present = {0, 1, 1};
  Hits hits;
  renderer(scene)->cast({.beams = beams,
                         .world_from_sensor = turned(0.2, {0.0, 1.0, 0.0}, {-0.6, 0.1, -3.0}),
                         .hit_columns = {},
                         .instance_enabled = present},
                        hits);
  EXPECT_GT(count(hits, 1), 300U);
  EXPECT_EQ(count(hits, 0) + count(hits, 2), 0U);
}

TEST_P(CoincidentSurfaces, TheFirstOfMeshesWithEqualGeometryIsReported) {
  Scene scene = builtin_scene("torus");
  Mesh other = scene.meshes[0];
  std::reverse(other.triangles.begin(), other.triangles.end());
  add(scene, std::move(other));
  expect_first_only(scene, 1000);
}

TEST_P(CoincidentSurfaces, TheFirstOfOppositeWindingsIsReported) {
  Scene scene = builtin_scene("torus");
  Mesh other = scene.meshes[0];
  for (Triangle& t : other.triangles) std::swap(t[0], t[1]);
  add(scene, std::move(other));
  expect_first_only(scene, 1000);
}

TEST_P(CoincidentSurfaces, TheFirstOfMeshesThatAreEqualAfterScalingIsReported) {
  Scene scene = builtin_scene("asteroid");
  scene.instances[0].world_from_object = turned(1.1, {0.3, -1.0, 0.2}, {12.5, 3.0, -4.0});
  Mesh half = scene.meshes[0];
  for (Eigen::Vector3f& p : half.positions_m) p *= 0.25F;  // exact
  half.origin_m *= 0.25;
  add(scene, std::move(half)).scale = 4.0;
  expect_first_only(scene, 1000);
}

/// Two planes at z = 0 of a common frame, one three times as large, with other triangles and axes.
Scene planes_in_one_place(const Pose& world_from_planes, bool is_large_first) {
  Scene scene = builtin_scene("plane");
  scene.instances.push_back(scene.instances[0]);
  Instance& large = scene.instances[is_large_first ? 0 : 1];
  Instance& small = scene.instances[is_large_first ? 1 : 0];
  large.scale = 3.0;
  large.world_from_object =
      world_from_planes * turned(0.3, Eigen::Vector3d::UnitZ(), {0.25, -0.125, 0.0});
  small.world_from_object = world_from_planes;
  return scene;
}

/// Casts at both, from an offset (x, y, z) in the planes' frame, and expects the small plane (if it
/// comes first) exactly where beams hit it.
void expect_small_inside_large(const Scene& scene, const Hits& hits, const Beams& beams,
                               const Pose& planes_from_sensor) {
  std::size_t on_small = 0;
  std::size_t on_large = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (hits.instance[i] == kInvalidId) continue;
    const Eigen::Vector3d direction = planes_from_sensor.linear() * beams.directions[i];
    const Eigen::Vector3d eye = planes_from_sensor.translation();
    const Eigen::Vector3d point = eye - eye.z() / direction.z() * direction;
    const double beyond = point.head<2>().cwiseAbs().maxCoeff() - 1.0;
    if (std::abs(beyond) < 1e-5 * eye.norm()) continue;  // single precision at the border
    EXPECT_EQ(hits.instance[i], beyond < 0.0 ? 0U : 1U) << "beam " << i;
    ++(beyond < 0.0 ? on_small : on_large);
  }
  EXPECT_GT(on_small, 500U);
  EXPECT_GT(on_large, 500U);
  EXPECT_EQ(scene.instances.size(), 2U);
}

TEST_P(CoincidentSurfaces, TheFirstOfCoplanarSurfacesWithOtherTrianglesIsReported) {
  const Pose world_from_planes = turned(0.9, {1.0, 0.4, -0.3}, {100.0, -20.0, 7.0});
  for (const double distance_m : {3.0, 300.0, 10000.0}) {
    const Beams beams = camera_beams(100, 100, 25.0 * distance_m);
    const Pose planes_from_sensor = look_at(distance_m * Eigen::Vector3d(0.3, 0.4, 0.866),
                                            Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitY());
    const Scene large_first = planes_in_one_place(world_from_planes, true);
    const Hits all = cast(large_first, beams, world_from_planes * planes_from_sensor);
    EXPECT_EQ(count(all, 1), 0U) << "at " << distance_m << " m";
    EXPECT_GT(count(all, 0), 3000U) << "at " << distance_m << " m";
    const Scene small_first = planes_in_one_place(world_from_planes, false);
    const Hits both = cast(small_first, beams, world_from_planes * planes_from_sensor);
    expect_small_inside_large(small_first, both, beams, planes_from_sensor);
  }
}

TEST_P(CoincidentSurfaces, ASurfaceNearerThanSinglePrecisionResolvesIsReported) {
  for (const std::uint32_t nearer : {0U, 1U}) {
    Scene scene = planes_in_one_place(Pose(Eigen::Translation3d(0.0, 0.0, 3.0)), true);
    scene.instances[nearer].world_from_object.translation().z() -= 1e-9;
    scene.instances[1].scale = 4.0;
    const Hits hits = cast(scene, camera_beams(60, 60, 60.0), Pose::Identity());
    EXPECT_EQ(count(hits, nearer), 3600U);
  }
}

/// A ground and 400 plates in the ground's plane; the ground comes last.
Scene plates_on_ground(const Pose& world) {
  Scene scene = builtin_scene("plane");
  Instance one = scene.instances[0];
  scene.instances.clear();
  for (int i = 0; i < 400; ++i) {
    one.scale = 0.2;
    one.world_from_object =
        world * turned(0.1 * i, Eigen::Vector3d::UnitZ(), {i % 20 - 9.5, i / 20 - 9.5, 0.0});
    scene.instances.push_back(one);
  }
  one.scale = 20.0;
  one.world_from_object = world;
  scene.instances.push_back(one);
  return scene;
}

TEST_P(CoincidentSurfaces, PlatesInTheGroundPlaneAreReportedUnlessAGroundIsInFront) {
  const Pose world = turned(2.0, {1.0, 0.7, -0.4}, {3.0, 40.0, -5.0});
  const Pose pose = world * look_at({0.0, -6.0, 12.0}, {0.1, 0.2, 0.0}, Eigen::Vector3d::UnitZ());
  const Beams beams = camera_beams(160, 120, 150.0);
  Scene scene = plates_on_ground(world);
  const Hits hits = cast(scene, beams, pose);
  const std::size_t on_plates = beams.size() - count(hits, 400) - count(hits, kInvalidId);
  EXPECT_GT(count(hits, 400), 1000U);
  EXPECT_GT(on_plates, 1000U);
  std::size_t checked = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (hits.instance[i] == kInvalidId) continue;
    const Eigen::Vector3d point =
        world.inverse() * (pose * (hits.range_m[i] * beams.directions[i]));
    const Eigen::Vector2d cell = (point.head<2>().array() + 10.0).floor();
    if (cell.minCoeff() < 0.0 || cell.maxCoeff() > 19.0) continue;
    const auto plate = static_cast<std::uint32_t>(cell.x() + 20.0 * cell.y());
    const Eigen::Vector3d local =
        scene.instances[plate].world_from_object.inverse() * (world * point);
    const double beyond = local.head<2>().cwiseAbs().maxCoeff() - 0.2;
    if (std::abs(beyond) < 1e-4) continue;  // single precision at the border
    ++checked;
    EXPECT_EQ(hits.instance[i], beyond < 0.0 ? plate : 400U) << i;
  }
  EXPECT_GT(checked, 5000U);
  std::rotate(scene.instances.begin(), scene.instances.end() - 1, scene.instances.end());
  const Hits hidden = cast(scene, beams, pose);
  EXPECT_EQ(count(hidden, 0), beams.size() - count(hits, kInvalidId));
}

/// A floor, and a wall across it 3 m ahead, in a rotated world. The sensor is in the floor's
/// plane and so is every beam, so that rounding decides where a beam hits the floor.
struct EdgeOnFloor {
  Scene scene = testing::builtin_scene("plane");
  Pose world_from_sensor;

  explicit EdgeOnFloor(const Pose& world) {
    const auto quarter = [](const Eigen::Vector3d& axis) {
      return turned(0.5 * std::numbers::pi, axis, Eigen::Vector3d::Zero());
    };
    scene.instances.push_back(scene.instances[0]);
    scene.instances[0].scale = 10.0;
    scene.instances[0].world_from_object = world;
    scene.instances[1].scale = 4.0;
    scene.instances[1].world_from_object = world * quarter(Eigen::Vector3d::UnitY());
    // Forward along x of the floor, to the right along -y.
    world_from_sensor = world * Eigen::Translation3d(-3.0, 0.3, 0.0) *
                        quarter(-Eigen::Vector3d::UnitX()) * quarter(Eigen::Vector3d::UnitY());
  }
};

TEST_P(CoincidentSurfaces, AFloorSeenEdgeOnIsNotReportedBehindTheWallInFront) {
  testing::Draws draws(5);
  const Beams beams = camera_beams(65, 1, 100.0);
  std::size_t on_wall = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d at(draws.next(), draws.next(), draws.next());
    const EdgeOnFloor stage(turned(6.0 * draws.next(), draws.direction(), at));
    const Hits hits = cast(stage.scene, beams, stage.world_from_sensor);
    on_wall += count(hits, 1);
    for (std::size_t k = 0; k < beams.size(); ++k) {
      ASSERT_NE(hits.instance[k], kInvalidId) << "world " << i << ", beam " << k;
      EXPECT_LE(hits.range_m[k] * beams.directions[k].z(), 3.0 + 1e-9)
          << "world " << i << ", beam " << k << ", instance " << hits.instance[k];
    }
  }
  EXPECT_GT(on_wall, 1000U);
}

TEST_P(CoincidentSurfaces, CullingKeepsTheFrontFacingSurface) {
  Scene scene = builtin_scene("plane");
  Mesh other = scene.meshes[0];
  for (Triangle& t : other.triangles) std::swap(t[0], t[1]);
  add(scene, std::move(other));
  const Pose behind = look_at({0.1, 0.2, -1.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitY());
  const Beams beams = camera_beams(30, 30, 60.0);
  EXPECT_EQ(count(cast(scene, beams, behind, false), 0), 900U);
  EXPECT_EQ(count(cast(scene, beams, behind, true), 1), 900U);
}

TEST_P(CoincidentSurfaces, HolesOfTheFirstShowTheSecond) {
  Scene scene = builtin_scene("plane");
  add(scene, scene.meshes[0]);
  scene.textures.push_back(
      {.name = "mask", .width = 2, .height = 1, .channels = 1, .texels = {0, 255}});
  scene.materials.push_back(scene.materials[0]);
  scene.instances[1].materials = {1};
  Material& material = scene.materials[0];
  material.alpha_cutoff = 0.5F;
  material.alpha_texture = {.texture = 0, .wrap_u = Wrap::clamp, .filter = Filter::nearest};
  const Pose pose = look_at({0.0, 0.0, 1.5}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitY());
  const Beams beams = camera_beams(16, 16, 16.0);
  const Hits hits = cast(scene, beams, pose);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const double x = (pose.linear() * beams.directions[i]).x();
    EXPECT_EQ(hits.instance[i], x > 0.0 ? 0U : 1U) << i;
  }
}

/// Two nearly coincident surfaces of one mesh with different triangles.
Mesh two_sheets(float height_m) {
  constexpr int kSide = 12;
  Mesh mesh;
  for (const bool is_upper : {false, true}) {
    const Eigen::Rotation2Df turn(is_upper ? 0.4F : 0.0F);
    const auto first = static_cast<std::uint32_t>(mesh.positions_m.size());
    for (int k = 0; k < kSide * kSide; ++k) {
      const Eigen::Vector2f at = turn * Eigen::Vector2f(static_cast<float>(k % kSide) - 5.5F,
                                                        static_cast<float>(k / kSide) - 5.5F);
      mesh.positions_m.emplace_back(at.x(), at.y(), is_upper ? height_m : 0.0F);
    }
    for (std::uint32_t k = 0; k + kSide + 1 < kSide * kSide; ++k) {
      if (k % kSide == kSide - 1) continue;
      const std::uint32_t at = first + k;
      mesh.triangles.push_back({at, at + 1, at + kSide});
      mesh.triangles.push_back({at + 1, at + kSide + 1, at + kSide});
    }
  }
  return mesh;
}

TEST_P(CoincidentSurfaces, NearlyCoincidentSurfacesOfOneMeshEqualRays) {
  const Beams beams = camera_beams(120, 90, 100.0);
  for (const float height_m : {0.0F, 1e-9F, 1e-7F, -1e-7F, 1e-6F, 1e-5F, 1e-3F}) {
    Scene scene = builtin_scene("plane");
    scene.meshes[0] = two_sheets(height_m);
    for (const double distance_m : {3.0, 30.0, 3000.0}) {
      const Pose pose = look_at(distance_m * Eigen::Vector3d(0.5, -0.4, 0.77), {0.1, 0.2, 0.0},
                                Eigen::Vector3d::UnitZ());
      const Hits hits = cast(scene, beams, pose);
      const auto rays = make_renderer(scene, {.kind = "rays"});
      Hits expected;
      rays->cast({.beams = beams, .world_from_sensor = pose}, expected);
      EXPECT_EQ(hits.primitive, expected.primitive) << height_m << " m, from " << distance_m;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, CoincidentSurfaces, ::testing::ValuesIn(renderer_kinds()),
                         [](const auto& test) { return test.param; });

using Indices = std::vector<std::uint32_t>;

Indices distinct(const Mesh& mesh) {
  return distinct_triangles(mesh, find_first_coincident(mesh));
}

/// Corners of a square, each twice.
Mesh square() {
  Mesh mesh;
  for (int copy = 0; copy < 2; ++copy) {
    for (const auto& [x, y] : {std::pair{0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 1.0F}, {0.0F, 1.0F}}) {
      mesh.positions_m.emplace_back(x, y, 0.0F);
    }
  }
  return mesh;
}

TEST(DistinctTriangles, KeepsAllTrianglesThatDiffer) {
  Mesh mesh = square();
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_TRUE(distinct(mesh).empty());
  EXPECT_TRUE(distinct(Mesh{}).empty());
}

TEST(DistinctTriangles, RemovesLaterTrianglesWithEqualCornersAndWinding) {
  Mesh mesh = square();
  mesh.triangles = {{0, 1, 2}, {1, 2, 0}, {0, 2, 3}, {4, 5, 6}, {6, 7, 4}};
  EXPECT_EQ(distinct(mesh), (Indices{0, 2}));
}

TEST(DistinctTriangles, KeepsOneTriangleOfEachWinding) {
  Mesh mesh = square();
  mesh.triangles = {{0, 1, 2}, {2, 1, 0}, {5, 4, 6}, {0, 2, 3}, {0, 1, 2}};
  EXPECT_EQ(distinct(mesh), (Indices{0, 1, 3}));
}

class Copies : public testing::RendererSuite {};

TEST_P(Copies, ReportTheFirstTriangleOfEachPair) {
  Scene scene = testing::builtin_scene("asteroid");
  const Scene single = scene;
  std::vector<Triangle>& triangles = scene.meshes[0].triangles;
  const std::size_t count = triangles.size();
  for (std::size_t i = 0; i < count; ++i) {  // turned on, and inside out
    const auto [a, b, c] = triangles[i];
    triangles.push_back({b, c, a});
    triangles.push_back({c, b, a});
  }
  const Beams beams = testing::camera_beams(90, 70, 90.0);
  const Pose pose = look_at({2.0, -2.5, 1.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  for (const bool culls : {false, true}) {
    const auto cast_at = [&](const Scene& of) {
      Hits hits;
      renderer(of)->cast(
          {.beams = beams, .world_from_sensor = pose, .hit_columns = {}, .cull_back_faces = culls},
          hits);
      return hits;
    };
    const Hits twice = cast_at(scene);
    const Hits once = cast_at(single);
    EXPECT_EQ(twice.primitive, once.primitive) << culls;
    EXPECT_GT(std::count(once.instance.begin(), once.instance.end(), 0U), 1000);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Copies, ::testing::ValuesIn(renderer_kinds()),
                         [](const auto& test) { return test.param; });

}  // namespace

}  // namespace glidar
