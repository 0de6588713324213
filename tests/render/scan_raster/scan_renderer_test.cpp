// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The scanner raster returns the same bits as rays.
#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/render/rays/kernels.hpp>
#include <glidar/render/scan_raster/kernels.hpp>
#include <render/scan_raster/scanner.hpp>
#include <render/scan_raster/scenes.hpp>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::Draws;
using testing::expect_same_as_rays;
using testing::make_room;
using testing::make_soup;
using testing::RasterAndRays;
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
    const RasterAndRays casters(scene);
    const Beams beams = scanner_beams({});
    EXPECT_GT(casters.expect_same(beams, Pose::Identity()), beams.size() / 4);
    EXPECT_GT(casters.expect_same(beams, turned(1.0, {1.0, 2.0, 3.0}, {0.6, 0.05, 0.02})),
              beams.size() / 20);
    EXPECT_GT(casters.expect_same(beams, turned(2.0, {1.0, -2.0, 3.0}, {2.0, 1.0, 0.3})),
              beams.size() / 100);
  }
}

TEST(ScanRenderer, EqualsRaysForGridsOfAllKinds) {
  const Scene room = make_room();
  const Scene soup = make_soup(3, 500, 4.0);
  const RasterAndRays room_casters(room);
  const RasterAndRays soup_casters(soup);
  for (const Scanner& scanner : scanners()) {
    const Beams beams = scanner_beams(scanner);
    EXPECT_GT(room_casters.expect_same(beams, at(0.3, 0.1, 0.0)), 0U);
    EXPECT_GT(room_casters.expect_same(beams, turned(0.7, {1.0, 1.0, 0.3}, {-0.5, 0.3, 0.4})), 0U);
    soup_casters.expect_same(beams, at(0.1, 0.2, 0.3));
  }
}

TEST(ScanRenderer, IsExactFarFromTheObject) {
  constexpr double kDistance_m = 1e4;
  constexpr double kWidth_rad = 3.0 / kDistance_m;
  const Beams narrow = scanner_beams({.rows = 16,
                                      .cols = 64,
                                      .low_rad = -kWidth_rad,
                                      .high_rad = kWidth_rad,
                                      .start_rad = -kWidth_rad,
                                      .span_rad = 2.0 * kWidth_rad});
  EXPECT_GT(expect_same_as_rays(builtin_scene("asteroid"), narrow, at(-kDistance_m, 0.0, 0.0)), 0U);
}

TEST(ScanRenderer, SkipsDisabledInstancesAndMovesTheOthers) {
  const Scene room = make_room();
  const RasterAndRays casters(room);
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
  EXPECT_GT(casters.expect_same(request), 0U);
  std::fill(present.begin(), present.end(), std::uint8_t{0});
  EXPECT_EQ(casters.expect_same(request), 0U);
}

TEST(ScanRenderer, CellsWithoutABeamAreMisses) {
  const Scene room = make_room();
  Beams beams = scanner_beams({.rows = 16, .cols = 300});
  Draws draws(8);
  for (Eigen::Vector3d& direction : beams.directions) {
    if (draws.next() < 0.3) direction.setConstant(kNaN);
  }
  for (std::size_t col = 0; col < beams.cols; ++col) {
    beams.directions[5 * beams.cols + col].setConstant(kNaN);
  }
  EXPECT_GT(expect_same_as_rays(room, beams, at(0.0, 0.0, 0.2)), 0U);
}

TEST(ScanRenderer, EqualsRaysForBeamsWithSeparateOrigins) {
  const Scene room = make_room();
  const Scene soup = make_soup(9, 500, 4.0);
  const RasterAndRays room_casters(room);
  const RasterAndRays soup_casters(soup);
  for (const double origin_m : {1e-9, 0.05, 3.0}) {
    for (Scanner scanner : scanners()) {
      scanner.origin_m = origin_m;
      if (origin_m > 1.0) scanner.rows = std::min(scanner.rows, 4U);
      const Beams beams = scanner_beams(scanner);
      EXPECT_GT(room_casters.expect_same(beams, turned(0.3, {0.2, 1.0, 0.1}, {0.3, 0.1, 0.0})), 0U);
      soup_casters.expect_same(beams, at(0.1, 0.2, 0.3));
    }
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
