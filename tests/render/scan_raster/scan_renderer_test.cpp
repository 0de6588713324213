// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The scanner raster returns the same bits as rays.
#include <glidar/core/error.hpp>
#include <glidar/render/rays/kernels.hpp>
#include <glidar/render/scan_raster/kernels.hpp>
#include <render/scan_raster/scanner.hpp>
#include <render/scan_raster/scenes.hpp>

#include <cstdlib>
#include <limits>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::cast_with;
using testing::Draws;
using testing::expect_same_as_rays;
using testing::expect_same_hits;
using testing::make_room;
using testing::make_soup;
using testing::Scanner;
using testing::scanner_beams;
using testing::turned;

Pose at(double x, double y, double z) {
  return make_pose({x, y, z}, Eigen::Quaterniond::Identity());
}

std::vector<Scanner> scanners() {
  return {{.rows = 1, .cols = 120},
          {.rows = 30, .cols = 1},
          {.rows = 1, .cols = 1},
          {.rows = 16, .cols = 450, .low_rad = -0.26, .high_rad = 0.26},
          {.rows = 64, .cols = 512, .low_rad = -0.43, .high_rad = 0.03, .stagger_rad = 0.031},
          {.rows = 9, .cols = 333, .span_rad = -2.0 * std::numbers::pi, .uneven = 0.7},
          {.rows = 40, .cols = 200, .start_rad = -0.8, .span_rad = 1.5, .uneven = 1.5},
          {.rows = 33, .cols = 700, .low_rad = -1.3, .high_rad = 1.35},
          {.rows = 21, .cols = 200, .span_rad = 3.0 * std::numbers::pi}};
}

TEST(ScanRenderer, HasTheKernelsOfTheRayCaster) {
  for (const rays::Kernel* kernel : rays::usable_kernels()) {
    EXPECT_EQ(std::string(scan_raster::find_kernel(kernel->name).name), kernel->name);
  }
  EXPECT_THROW(scan_raster::find_kernel("sse9"), Error);
}

TEST(ScanRenderer, EqualsRaysInsideAndOutsideOfASphere) {
  for (const char* model : {"asteroid", "torus", "sphere", "box"}) {
    const Scene scene = builtin_scene(model);
    const Beams beams = scanner_beams({});
    EXPECT_GT(expect_same_as_rays(scene, beams, Pose::Identity()), beams.size() / 4);
    EXPECT_GT(expect_same_as_rays(scene, beams, turned(1.0, {1.0, 2.0, 3.0}, {0.6, 0.05, 0.02})),
              beams.size() / 20);
    EXPECT_GT(expect_same_as_rays(scene, beams, turned(2.0, {1.0, -2.0, 3.0}, {2.0, 1.0, 0.3})),
              beams.size() / 100);
  }
}

TEST(ScanRenderer, EqualsRaysForGridsOfAllKinds) {
  const Scene room = make_room();
  const Scene soup = make_soup(3, 500, 4.0);
  for (const Scanner& scanner : scanners()) {
    const Beams beams = scanner_beams(scanner);
    EXPECT_GT(expect_same_as_rays(room, beams, at(0.3, 0.1, 0.0)), 0U);
    EXPECT_GT(expect_same_as_rays(room, beams, turned(0.7, {1.0, 1.0, 0.3}, {-0.5, 0.3, 0.4})), 0U);
    expect_same_as_rays(soup, beams, at(0.1, 0.2, 0.3));
  }
}

TEST(ScanRenderer, EqualsRaysForRandomOriginsInTriangleSoups) {
  Draws draws(5);
  const Beams beams = scanner_beams({.rows = 24, .cols = 240, .uneven = 0.3});
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const double size_m = std::pow(10.0, 4.0 * draws.next() - 2.0);
    const Scene scene = make_soup(seed, 400, size_m);
    const Eigen::Vector3d origin = size_m * draws.direction() * draws.next();
    expect_same_as_rays(scene, beams, turned(6.0 * draws.next(), draws.direction(), origin));
  }
}

TEST(ScanRenderer, EqualsRaysFromVerticesAndInPlanesOfTriangles) {
  const Scene room = make_room();
  const Beams beams = scanner_beams({.rows = 17, .cols = 360, .low_rad = -0.4, .high_rad = 0.4});
  for (std::uint32_t i = 0; i < room.instances.size(); ++i) {
    const Instance& instance = room.instances[i];
    const Mesh& mesh = room.meshes[instance.mesh];
    for (const std::size_t k : {std::size_t{0}, mesh.positions_m.size() / 2}) {
      const Eigen::Vector3d vertex =
          instance.world_from_object * (instance.scale * mesh.positions_m[k].cast<double>());
      expect_same_as_rays(room, beams, turned(0.0, {0.0, 0.0, 1.0}, vertex));
      expect_same_as_rays(room, beams, turned(1.0, {1.0, 0.0, 1.0}, vertex));
    }
  }
  // Level beams run in the box's plane.
  expect_same_as_rays(builtin_scene("box"), beams, at(-3.0, 0.2, 1.0));
}

TEST(ScanRenderer, FindsTheLowestOfCoincidentSurfacesOfSeveralInstances) {
  Scene scene = builtin_scene("torus");
  scene.instances.push_back(scene.instances[0]);
  Scene turned_scene = scene;
  const Pose pose = turned(0.7, {0.3, 0.2, 1.0}, {0.1, 0.0, 0.0});
  for (Instance& instance : turned_scene.instances) instance.world_from_object = pose;
  turned_scene.instances[1].scale = 1.0 + 1e-15;
  const Beams beams = scanner_beams({.rows = 20, .cols = 200});
  for (const Scene& doubled : {scene, turned_scene}) {
    EXPECT_GT(expect_same_as_rays(doubled, beams, at(1.0, 0.0, 0.0)), 0U);
    EXPECT_GT(expect_same_as_rays(doubled, beams, at(3.0, 0.3, 0.1)), 0U);
  }
}

TEST(ScanRenderer, IsExactFarFromTheWorldsOriginAndFromTheObject) {
  const Scene near = builtin_scene("asteroid");
  Scene far = near;
  const Eigen::Vector3d offset(1e9, -2e9, 5e8);
  far.instances[0].world_from_object.translation() = offset;
  const Beams beams = scanner_beams({.rows = 21, .cols = 400});
  Pose pose = turned(0.4, {0.0, 1.0, 2.0}, offset + Eigen::Vector3d(0.1, 0.2, 0.0));
  EXPECT_GT(expect_same_as_rays(far, beams, pose), 0U);
  // A narrow scanner looks at the body from 1e6 m and 1e9 m away.
  for (const double distance_m : {1e6, 1e9}) {
    const double width_rad = 3.0 / distance_m;
    if (width_rad / 64.0 < 1e-6) continue;
    expect_same_as_rays(near,
                        scanner_beams({.rows = 16,
                                       .cols = 64,
                                       .low_rad = -width_rad,
                                       .high_rad = width_rad,
                                       .start_rad = -width_rad,
                                       .span_rad = 2.0 * width_rad}),
                        at(-distance_m, 0.0, 0.0));
  }
  Scene huge = near;
  huge.instances[0].scale = 1e9;
  expect_same_as_rays(huge, beams, at(-1.5e9, 0.0, 0.0));
  huge.instances[0].scale = 1e-9;
  expect_same_as_rays(huge, beams, at(-1.5e-9, 0.0, 0.0));
}

TEST(ScanRenderer, CullsBackFacesAndAppliesAlphaMasks) {
  const Beams beams = scanner_beams({.rows = 16, .cols = 300});
  Scene room = make_room();
  EXPECT_GT(expect_same_as_rays(room, {.beams = beams,
                                       .world_from_sensor = at(0.0, 0.0, 0.2),
                                       .hit_columns = kAllHitColumns,
                                       .cull_back_faces = true}),
            0U);
  for (Material& material : room.materials) material.alpha_cutoff = 0.5F;
  expect_same_as_rays(room, beams, at(0.0, 0.0, 0.2));
}

TEST(ScanRenderer, SkipsDisabledInstancesAndMovesTheOthers) {
  const Scene room = make_room();
  const Beams beams = scanner_beams({.rows = 16, .cols = 300});
  std::vector<std::uint8_t> present(room.instances.size(), 1);
  present[0] = 0;
  std::vector<Pose> poses;
  for (const Instance& instance : room.instances) {
    poses.push_back(turned(0.1, {1.0, 0.0, 0.0}, {0.0, 0.1, 0.2}) * instance.world_from_object);
  }
  CastRequest request{.beams = beams,
                      .world_from_sensor = at(0.0, 0.0, 0.2),
                      .world_from_instance = poses,
                      .hit_columns = kAllHitColumns,
                      .instance_enabled = present};
  EXPECT_GT(expect_same_as_rays(room, request), 0U);
  std::fill(present.begin(), present.end(), std::uint8_t{0});
  EXPECT_EQ(expect_same_as_rays(room, request), 0U);
}

TEST(ScanRenderer, CellsWithoutABeamAreMisses) {
  const Scene room = make_room();
  Beams beams = scanner_beams({.rows = 16, .cols = 300});
  Draws draws(8);
  for (Eigen::Vector3d& direction : beams.directions) {
    if (draws.next() < 0.3) direction.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  for (std::size_t col = 0; col < beams.cols; ++col) {
    beams.directions[5 * beams.cols + col].setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  EXPECT_GT(expect_same_as_rays(room, beams, at(0.0, 0.0, 0.2)), 0U);
}

TEST(ScanRenderer, EqualsRaysForRepeatedAndSteepRows) {
  const Scene room = make_room();
  Beams beams = scanner_beams({.rows = 16, .cols = 300, .low_rad = -0.3, .high_rad = 1.5});
  const std::vector<Eigen::Vector3d> once = beams.directions;
  beams.directions.insert(beams.directions.end(), once.begin(), once.end());
  beams.rows *= 2;
  beams.returns = 2;
  EXPECT_GT(expect_same_as_rays(room, beams, at(0.0, 0.0, 0.2)), 0U);
}

TEST(ScanRenderer, EqualsRaysForBeamsWithSeparateOrigins) {
  const Scene room = make_room();
  const Scene soup = make_soup(9, 500, 4.0);
  for (const double origin_m : {1e-9, 0.05, 3.0}) {
    for (Scanner scanner : scanners()) {
      scanner.origin_m = origin_m;
      if (origin_m > 1.0) scanner.rows = std::min(scanner.rows, 4U);
      const Beams beams = scanner_beams(scanner);
      EXPECT_GT(expect_same_as_rays(room, beams, turned(0.3, {0.2, 1.0, 0.1}, {0.3, 0.1, 0.0})),
                0U);
      expect_same_as_rays(soup, beams, at(0.1, 0.2, 0.3));
    }
  }
}

TEST(ScanRenderer, DetectsBeamsThatChangedInPlace) {
  const Scene room = make_room();
  Beams beams = scanner_beams({.rows = 16, .cols = 300});
  const auto raster = make_renderer(room, {.kind = "raster", .threads = 2});
  for (int k = 0; k < 3; ++k) {
    const CastRequest request{
        .beams = beams, .world_from_sensor = at(0.0, 0.0, 0.2), .hit_columns = kAllHitColumns};
    Hits hits;
    raster->cast(request, hits);
    EXPECT_GT(expect_same_hits(hits, cast_with("rays", room, request)), 0U);
    const Eigen::Matrix3d turn = turned(0.1, {0.1, 0.0, 1.0}, {0.0, 0.0, 0.0}).linear();
    for (Eigen::Vector3d& direction : beams.directions) direction = (turn * direction).normalized();
  }
}

TEST(ScanRenderer, ReportsEveryBeamOnceAndAllProgress) {
  const Scene room = make_room();
  Beams beams = scanner_beams({.rows = 18, .cols = 300, .high_rad = 1.5, .stagger_rad = 0.04});
  std::vector<int> reported(beams.size(), 0);
  double progress = 0.0;
  const auto count = [&](BeamRange range) {
    for (std::size_t i = range.begin; i < range.end; ++i) ++reported[i];
  };
  Hits hits;
  make_renderer(room, {.kind = "raster", .threads = 1})
      ->cast({.beams = beams,
              .world_from_sensor = at(0.0, 0.0, 0.2),
              .on_tile_done = FunctionRef<void(BeamRange)>(count),
              .progress = [&](double part) { progress = part; }},
             hits);
  EXPECT_EQ(reported, std::vector<int>(beams.size(), 1));
  EXPECT_EQ(progress, 1.0);
}

TEST(ScanRenderer, HasTheSameBitsWithEveryInstructionSet) {
  const Scene room = make_room();
  for (const double origin_m : {0.0, 0.05}) {
    const Beams beams = scanner_beams({.rows = 32, .cols = 512, .origin_m = origin_m});
    const CastRequest request{
        .beams = beams, .world_from_sensor = at(0.0, 0.0, 0.2), .hit_columns = kAllHitColumns};
    const Hits expected = cast_with("rays", room, request);
    for (const rays::Kernel* kernel : rays::usable_kernels()) {
      setenv("GLIDAR_ISA", kernel->name, 1);
      expect_same_hits(cast_with("raster", room, request), expected);
    }
    unsetenv("GLIDAR_ISA");
  }
}

TEST(ScanRenderer, RejectsBeamsThatFormNoGrid) {
  const Scene room = make_room();
  Draws draws(8);
  Beams beams = scanner_beams({.rows = 16, .cols = 300});
  for (Eigen::Vector3d& direction : beams.directions) direction = draws.direction();
  Hits hits;
  EXPECT_THROW(make_renderer(room, {.kind = "raster"})->cast({.beams = beams}, hits), Error);
}

}  // namespace
}  // namespace glidar
