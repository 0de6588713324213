// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Tests that every renderer must pass. New renderers join automatically; those that cast beams of
// any pattern are listed at the end.
#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <render/renderer_suite.hpp>
#include <support/error_text.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace glidar {
namespace {

using testing::AnyBeamsSuite;
using testing::builtin_scene;
using testing::camera_beams;
using testing::Draws;
using testing::Judged;
using testing::loose_beams;
using testing::RendererSuite;
using testing::turned;

/// At this distance from an edge (relative to the scene's size), the neighbour may be reported.
constexpr double kBorder = 1e-5;
/// Both sides compute the range in double, by different formulas.
constexpr double kRangeTolerance = 1e-12;

/// Half the width, in pixels, of the band around an edge where a renderer may report the neighbour:
/// twice the step of a rasterizer's grid.
double border_px(const std::string& renderer) {
  return renderer == "raster" || renderer == "auto" ? 1.0 / 2048.0 : 0.0;
}

/// Compares every beam with brute force; returns how many were compared (not near an edge).
std::size_t expect_hits_of_rule(const Scene& scene, const Beams& beams,
                                const Pose& world_from_sensor, const Hits& hits,
                                double band_px = 0.0) {
  const double size = bounds(scene).diagonal().norm();
  const double focal_px = beams.pinhole ? beams.pinhole->fx : 1.0;
  const double farthest_m =
      (bounds(scene).center() - world_from_sensor.translation()).norm() + size;
  const testing::BruteForce brute_force(scene);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const Eigen::Vector3d offset =
        beams.origins_m.empty() ? Eigen::Vector3d::Zero() : beams.origins_m[i];
    const Eigen::Vector3d direction = world_from_sensor.linear() * beams.directions[i];
    const Judged truth = brute_force.judge(world_from_sensor * offset, direction);
    const double range_m = truth.instance == kInvalidId ? farthest_m : truth.range_m;
    if (truth.border_m < std::max(kBorder * size, band_px / focal_px * range_m)) continue;
    ++compared;
    EXPECT_EQ(hits.instance[i], truth.instance) << "beam " << i;
    EXPECT_EQ(hits.primitive[i], truth.primitive) << "beam " << i;
    if (truth.instance == kInvalidId) {
      EXPECT_TRUE(std::isnan(hits.range_m[i])) << "beam " << i;
      continue;
    }
    EXPECT_NEAR(hits.range_m[i], truth.range_m,
                kRangeTolerance * (size + world_from_sensor.translation().norm()))
        << "beam " << i;
    const Eigen::Vector3d towards =
        truth.normal.dot(direction) > 0.0 ? Eigen::Vector3d(-truth.normal) : truth.normal;
    const Eigen::Vector3d expected = world_from_sensor.linear().transpose() * towards;
    EXPECT_LT((hits.normal[i].cast<double>() - expected).norm(), 1e-6) << "beam " << i;
    EXPECT_NEAR(hits.cos_incidence[i], std::abs(truth.normal.dot(direction)), 1e-6);
  }
  return compared;
}

TEST_P(RendererSuite, EqualsBruteForceOnASphere) {
  const Scene scene = builtin_scene("sphere");
  const Beams beams = camera_beams(61, 43, 60.0);  // odd sizes: tiles beyond the border
  const Pose pose = look_at({2.0, 1.0, 1.5}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const Hits hits = cast(scene, beams, pose);
  EXPECT_GT(expect_hits_of_rule(scene, beams, pose, hits, border_px(GetParam())),
            beams.size() * 9 / 10);
}

TEST_P(RendererSuite, EqualsBruteForceAmongMovedAndScaledInstances) {
  Scene scene = builtin_scene("torus");
  add_model(scene, make_builtin_model("box"));
  add_model(scene, make_builtin_model("sphere"));
  scene.instances[0].world_from_object = turned(0.7, {1.0, 2.0, 3.0}, {0.4, -0.2, 3.0});
  scene.instances[1].world_from_object = turned(1.9, {-1.0, 0.3, 0.1}, {-1.0, 0.5, 5.0});
  scene.instances[1].scale = 0.75;
  scene.instances[2].world_from_object.translation() = Eigen::Vector3d(1.5, 1.0, 6.0);
  scene.instances[2].scale = 1.7;
  const Beams beams = camera_beams(48, 48, 50.0);
  const Hits hits = cast(scene, beams, Pose::Identity());
  const double band_px = border_px(GetParam());
  const std::size_t least = beams.size() * (band_px == 0.0 ? 18 : 17) / 20;
  EXPECT_GT(expect_hits_of_rule(scene, beams, Pose::Identity(), hits, band_px), least);
}

TEST_P(AnyBeamsSuite, FollowsBeamOriginsAndDirectionsInAllDirections) {
  const Scene scene = builtin_scene("box");
  Draws draws(7);
  std::vector<Eigen::Vector3d> directions;
  std::vector<Eigen::Vector3d> origins;
  for (int i = 0; i < 500; ++i) {
    directions.push_back(draws.direction());
    origins.push_back(0.8 * draws.direction());
  }
  const Beams beams = loose_beams(directions, origins);
  const Pose pose = turned(0.3, {0.0, 1.0, 1.0}, {0.05, 0.02, -0.03});
  const Hits hits = cast(scene, beams, pose);
  EXPECT_GT(expect_hits_of_rule(scene, beams, pose, hits), beams.size() * 9 / 10);
  for (const std::uint32_t instance : hits.instance) EXPECT_EQ(instance, 0U);  // it is closed
}

TEST_P(RendererSuite, IsExactTenKilometresAwayAndAThousandFromTheOrigin) {
  Scene scene = builtin_scene("box");
  scene.instances[0].world_from_object = turned(0.4, {0.2, 0.5, 1.0}, {1.0e6, -5.0e5, 2.5e5});
  const Eigen::Vector3d object = scene.instances[0].world_from_object.translation();
  const Pose pose =
      look_at(object + Eigen::Vector3d(6.0e3, 8.0e3, 0.0), object, Eigen::Vector3d::UnitZ());
  const Beams beams = camera_beams(40, 40, 40.0 / (4.0e-4));
  const Hits hits = cast(scene, beams, pose);
  std::size_t on_object = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (hits.instance[i] == kInvalidId) continue;
    ++on_object;
    // The hit point is on the box of half side 1: one coordinate is exactly 1, none is larger.
    const double largest = hits.object_point_m[i].cwiseAbs().maxCoeff();
    EXPECT_NEAR(largest, 1.0, 4e-10);  // a position of 1e6 m is known to 1.2e-10 m in double
  }
  EXPECT_GT(on_object, beams.size() / 4);
}

TEST_P(RendererSuite, AllColumnsAreConsistent) {
  Scene scene = builtin_scene("torus");
  scene.instances[0].scale = 2.0;
  scene.instances[0].world_from_object = turned(1.0, {1.0, 0.0, 0.2}, {0.0, 0.1, 7.0});
  const Beams beams = camera_beams(32, 32, 30.0);
  const Hits hits = cast(scene, beams, Pose::Identity());
  const Mesh& mesh = scene.meshes[0];
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (hits.instance[i] == kInvalidId) {
      EXPECT_TRUE(std::isnan(hits.depth_m[i]));
      EXPECT_TRUE(std::isnan(hits.normal[i].x()));
      EXPECT_TRUE(std::isnan(hits.object_point_m[i].x()));
      EXPECT_EQ(hits.colour[i], Eigen::Vector3f::Zero());
      continue;
    }
    const Eigen::Vector3d point = hits.range_m[i] * beams.directions[i];
    EXPECT_NEAR(hits.depth_m[i], point.z(), 1e-12);
    const Eigen::Vector3d seen =
        scene.instances[0].world_from_object * (2.0 * hits.object_point_m[i]);
    EXPECT_LT((seen - point).norm(), 1e-12);
    const Triangle& corners = mesh.triangles[hits.primitive[i]];
    const Eigen::Vector2f w = hits.barycentrics[i];
    const Eigen::Vector3f blended = (1.0F - w.x() - w.y()) * mesh.positions_m[corners[0]] +
                                    w.x() * mesh.positions_m[corners[1]] +
                                    w.y() * mesh.positions_m[corners[2]];
    EXPECT_LT((blended.cast<double>() + mesh.origin_m - hits.object_point_m[i]).norm(), 1e-6);
    EXPECT_LE(hits.normal[i].cast<double>().dot(beams.directions[i]),
              1e-6);  // turned to the sensor
    EXPECT_NEAR(hits.shading_normal[i].norm(), 1.0F, 1e-5F);
    EXPECT_NEAR(-hits.normal[i].cast<double>().dot(beams.directions[i]), hits.cos_incidence[i],
                1e-6);
    EXPECT_NEAR(-hits.shading_normal[i].cast<double>().dot(beams.directions[i]),
                hits.cos_shading[i], 1e-6);
  }
}

TEST_P(AnyBeamsSuite, APinholesIntrinsicsDoNotChangeResults) {
  const Scene scene = builtin_scene("asteroid");
  PinholeIntrinsics odd{.width = 203, .height = 101, .fx = 311.7, .fy = 287.3};
  odd.cx = 97.1;
  odd.cy = 55.9;
  odd.pixel_centre = 0.25;
  const Beams structured = testing::pinhole_beams(odd);
  Beams plain = structured;
  plain.pinhole.reset();
  const Pose pose = turned(0.1, {0.2, 1.0, 0.4}, {0.3, -0.2, -5.0});
  const Hits with = cast(scene, structured, pose);
  const Hits without = cast(scene, plain, pose);
  EXPECT_EQ(with.primitive, without.primitive);
  EXPECT_EQ(0, std::memcmp(with.range_m.data(), without.range_m.data(),
                           with.range_m.size() * sizeof(double)));
}

TEST_P(RendererSuite, AVastObjectBehindASmallOneIsExact) {
  // A satellite 20 m away in front of a globe as large as the Earth, 400 km below.
  Scene scene = builtin_scene("asteroid");
  add_model(scene, make_builtin_model("sphere"));
  const double radius_m = 6.4e6;
  scene.instances[0].world_from_object = turned(0.7, {1.0, 2.0, 3.0}, {0.0, 0.0, 20.0});
  scene.instances[1].world_from_object.translation().z() = radius_m + 4e5;
  scene.instances[1].scale = radius_m;
  const Beams beams = camera_beams(120, 90, 400.0);
  const Hits both = cast(scene, beams, Pose::Identity());
  Scene alone = builtin_scene("asteroid");
  alone.instances[0].world_from_object = scene.instances[0].world_from_object;
  const Hits small = cast(alone, beams, Pose::Identity());
  std::size_t of_small = 0;
  std::size_t differ = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (small.instance[i] == kInvalidId) {
      EXPECT_EQ(both.instance[i], 1U) << i;
      continue;
    }
    ++of_small;
    EXPECT_EQ(both.instance[i], 0U) << i;
    const bool is_same =
        both.primitive[i] == small.primitive[i] && both.range_m[i] == small.range_m[i];
    differ += is_same ? 0U : 1U;
  }
  EXPECT_GT(of_small, 500U);
  EXPECT_LE(differ, of_small / 500);
}

TEST_P(RendererSuite, CullsBackFacesOnlyOnRequest) {
  const Scene scene = builtin_scene("box");
  const Beams beams = camera_beams(8, 8, 8.0);
  const Hits both = cast(scene, beams, Pose::Identity());  // from inside: only backs
  for (const double range : both.range_m) EXPECT_FALSE(std::isnan(range));
  const Hits fronts = cast(scene, beams, Pose::Identity(), true);
  for (const double range : fronts.range_m) EXPECT_TRUE(std::isnan(range));
}

TEST_P(RendererSuite, CanCullAfterCastingWithout) {
  const Scene scene = builtin_scene("sphere");
  const Beams beams = camera_beams(9, 9, 20.0);
  const Pose pose = look_at({3.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const std::unique_ptr<Renderer> one = renderer(scene);
  Hits before;
  Hits culled;
  one->cast(
      {.beams = beams, .world_from_sensor = pose, .world_from_instance = {}, .hit_columns = {}},
      before);
  one->cast({.beams = beams,
             .world_from_sensor = pose,
             .world_from_instance = {},
             .hit_columns = {},
             .cull_back_faces = true},
            culled);
  EXPECT_EQ(before.primitive, culled.primitive);  // from outside fronts come first
}

TEST_P(RendererSuite, InstancesMoveWithTheRequestedPoses) {
  Scene scene = builtin_scene("sphere");
  add_model(scene, make_builtin_model("sphere"));
  const Beams beams = camera_beams(1, 1, 1.0);
  const std::unique_ptr<Renderer> one = renderer(scene);
  Hits hits;
  for (const double distance : {3.0, 8.0, 5.5}) {
    const std::vector<Pose> poses = {Pose(Eigen::Translation3d(0.0, 0.0, distance)),
                                     Pose(Eigen::Translation3d(100.0, 0.0, 0.0))};
    one->cast({.beams = beams,
               .world_from_sensor = Pose::Identity(),
               .world_from_instance = poses,
               .hit_columns = {}},
              hits);
    EXPECT_EQ(hits.instance[0], 0U);
    EXPECT_NEAR(hits.range_m[0], distance - 1.0, 2e-3);  // the facets lie just inside the sphere
  }
}

TEST_P(RendererSuite, TransparentTexelsLetTheBeamPass) {
  Scene scene = builtin_scene("plane");
  scene.textures.push_back(
      {.name = "mask", .width = 2, .height = 1, .channels = 1, .texels = {0, 255}});
  Material& material = scene.materials[scene.instances[0].materials[0]];
  material.alpha_cutoff = 0.5F;
  material.alpha_texture = {.texture = 0, .wrap_u = Wrap::clamp, .filter = Filter::nearest};
  const Beams beams = camera_beams(16, 16, 16.0);
  const Pose pose = look_at({0.0, 0.0, 1.5}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitY());
  const Hits hits = cast(scene, beams, pose);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const Eigen::Vector3d in_world = pose.linear() * beams.directions[i];
    const Eigen::Vector3d point = pose.translation() + in_world * (-1.5 / in_world.z());
    EXPECT_EQ(hits.instance[i] != kInvalidId, point.x() > 0.0) << point.transpose();
  }
}

TEST_P(RendererSuite, ReportsTheFirstOfCoincidentTriangles) {
  Scene scene = builtin_scene("sphere");
  Mesh& mesh = scene.meshes[0];
  const std::vector<Triangle> once = mesh.triangles;
  for (const Triangle& t : once) mesh.triangles.push_back({t[1], t[0], t[2]});  // the inner side
  const Pose pose = look_at({2.0, 1.0, 1.5}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const Hits hits = cast(scene, camera_beams(60, 60, 60.0), pose);
  std::size_t found = 0;
  for (const std::uint32_t primitive : hits.primitive) {
    if (primitive == kInvalidId) continue;
    ++found;
    EXPECT_LT(primitive, once.size());
  }
  EXPECT_GT(found, 500U);
}

TEST_P(AnyBeamsSuite, ABeamWithoutDirectionHitsNothing) {
  const Scene scene = builtin_scene("sphere");
  Beams beams = camera_beams(4, 4, 4.0);
  beams.pinhole.reset();
  beams.directions[5].setConstant(kNaN);
  const Hits hits = cast(scene, beams, Pose::Identity());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    EXPECT_EQ(hits.instance[i] == kInvalidId, i == 5);
  }
}

TEST_P(RendererSuite, RejectsInconsistentRequests) {
  const Scene scene = builtin_scene("box");
  Beams beams = camera_beams(4, 4, 4.0);
  beams.cols = 5;
  EXPECT_THROW(cast(scene, beams, Pose::Identity()), Error);
  beams.cols = 4;
  Pose far = Pose::Identity();
  far.translation().x() = 1e30;
  EXPECT_THROW(cast(scene, beams, far), Error);
}

TEST_P(RendererSuite, BeamsAtTheLimitsMissWithoutAnError) {
  const Scene scene = builtin_scene("box");
  Pose far = Pose::Identity();
  far.translation().x() = 1e15;
  for (const double range : cast(scene, camera_beams(4, 4, 4.0), far).range_m) {
    EXPECT_TRUE(std::isnan(range));
  }
}

TEST_P(RendererSuite, ABeamThatStartsOnASurfaceDoesNotSeeIt) {
  const Scene scene = builtin_scene("plane");
  const Pose pose = look_at({0.1, 0.1, 0.0}, {0.1, 0.1, -5.0}, Eigen::Vector3d::UnitY());
  for (const double range : cast(scene, camera_beams(8, 8, 8.0), pose).range_m) {
    EXPECT_TRUE(std::isnan(range));
  }
}

TEST_P(RendererSuite, AnEmptySceneIsAllMisses) {
  const Scene scene;
  const Hits hits = cast(scene, camera_beams(5, 3, 4.0), Pose::Identity());
  ASSERT_EQ(hits.range_m.size(), 15U);
  for (const double range : hits.range_m) EXPECT_TRUE(std::isnan(range));
}

TEST_P(RendererSuite, ResultsDoNotDependOnTheNumberOfThreads) {
  const Scene scene = builtin_scene("asteroid");
  const Beams beams = camera_beams(200, 150, 150.0);
  const Pose pose = look_at({3.0, 1.0, 1.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const CastRequest request{.beams = beams,
                            .world_from_sensor = pose,
                            .world_from_instance = {},
                            .hit_columns = kAllHitColumns};
  Hits one;
  Hits many;
  renderer(scene, 1)->cast(request, one);
  renderer(scene, 3)->cast(request, many);
  const auto same = [](const auto& a, const auto& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
  };
  EXPECT_TRUE(same(one.range_m, many.range_m));
  EXPECT_TRUE(same(one.primitive, many.primitive));
  EXPECT_TRUE(same(one.normal, many.normal));
  EXPECT_TRUE(same(one.shading_normal, many.shading_normal));
  EXPECT_TRUE(same(one.cos_shading, many.cos_shading));
  EXPECT_TRUE(same(one.barycentrics, many.barycentrics));
  EXPECT_TRUE(same(one.reflectance, many.reflectance));
  EXPECT_TRUE(same(one.object_point_m, many.object_point_m));
}

INSTANTIATE_TEST_SUITE_P(All, RendererSuite, ::testing::ValuesIn(renderer_kinds()),
                         [](const auto& test) { return test.param; });
INSTANTIATE_TEST_SUITE_P(All, AnyBeamsSuite, ::testing::Values("auto", "rays", "gpu"),
                         [](const auto& test) { return test.param; });

TEST(MakeRenderer, ListsTheKindsOnAnUnknownOne) {
  const Scene scene;
  EXPECT_EQ(error_text([&] { make_renderer(scene, {.kind = "ray"}); }),
            "renderer: 'ray' is not known; allowed: auto, rays, raster, gpu; did you mean 'rays'?");
}

TEST(MakeRenderer, OpenglIsAnotherNameOfGpu) {
  GLIDAR_NEEDS_GPU();
  const Scene scene;
  EXPECT_EQ(make_renderer(scene, {.kind = "opengl", .threads = 1})->name(), "gpu");
}

TEST(MakeRenderer, RejectsAnInvalidScene) {
  Scene scene = builtin_scene("box");
  scene.instances[0].mesh = 3;
  EXPECT_THROW(make_renderer(scene, {}), Error);
}

}  // namespace
}  // namespace glidar
