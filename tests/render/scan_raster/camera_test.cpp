// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The raster returns the same bits as rays for cameras with any lens.
#include <glidar/math/constants.hpp>
#include <render/scan_raster/scanner.hpp>
#include <render/scan_raster/scenes.hpp>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::Draws;
using testing::lens_beams;
using testing::make_room;
using testing::make_soup;
using testing::preset_beams;
using testing::RasterAndRays;
using testing::turned;

/// A pinhole without stored intrinsics.
Beams plain_beams(std::uint32_t width, std::uint32_t height, double focal_px) {
  Beams beams = testing::camera_beams(width, height, focal_px);
  beams.pinhole.reset();
  return beams;
}

std::vector<Beams> cameras() {
  std::vector<Beams> all = {
      plain_beams(160, 120, 90.0),
      plain_beams(40, 33, 3.0),  // 163 degrees
      plain_beams(64, 48, 4e5),
      lens_beams(171, 130, 100.0, RadialTangential{.k1 = -0.28, .k2 = 0.07}),  // barrel
      lens_beams(130, 171, 110.0,
                 RadialTangential{.k1 = 0.2, .p1 = 0.01, .p2 = 0.02}),  // pincushion
      lens_beams(160, 120, 60.0, RadialTangential{.k1 = -0.3, .max_radius = 0.9}),
      lens_beams(150, 150, 60.0, Fisheye{.k1 = 0.05, .k2 = -0.01}),
      lens_beams(200, 200, 45.0, Fisheye{}),  // beyond 90 degrees from its axis
      lens_beams(17, 16, 20.0, Fisheye{}),
  };
  all.push_back(preset_beams("Azure-Kinect-NFOV-2x2"));
  return all;
}

TEST(CameraRaster, EqualsRaysInsideAndOutsideOfASphere) {
  const std::vector<Beams> all = cameras();
  for (const char* model : {"asteroid", "torus", "sphere", "box"}) {
    const Scene scene = builtin_scene(model);
    const RasterAndRays casters(scene);
    for (const Beams& beams : all) {
      casters.expect_same(beams, Pose::Identity());
      casters.expect_same(beams, turned(1.0, {1.0, 2.0, 3.0}, {0.6, 0.05, 0.02}));
      const Pose outside = look_at({2.0, 1.0, 0.9}, {0.6, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
      EXPECT_GT(casters.expect_same(beams, outside), 0U);
    }
  }
}

TEST(CameraRaster, EqualsRaysForAllDistortingPresets) {
  const Scene room = make_room();
  const RasterAndRays casters(room);
  for (const char* name : {"Azure-Kinect-NFOV", "Azure-Kinect-NFOV-2x2", "Azure-Kinect-WFOV",
                           "Azure-Kinect-WFOV-2x2", "Kinect-v2"}) {
    const Beams beams = preset_beams(name);
    EXPECT_GT(casters.expect_same(beams, turned(0.7, {1.0, 1.0, 0.3}, {-0.5, 0.3, 0.4})),
              beams.size() / 2)
        << name;
  }
}

TEST(CameraRaster, EqualsRaysForTrianglesAcrossItsPlane) {
  Draws draws(5);
  const std::vector<Beams> all = cameras();
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const double size_m = std::pow(10.0, 4.0 * draws.next() - 2.0);
    const Scene scene = make_soup(seed, 400, size_m);
    const RasterAndRays casters(scene);
    for (const Beams& beams : all) {
      const Eigen::Vector3d origin = size_m * draws.direction() * draws.next();
      casters.expect_same(beams, turned(6.0 * draws.next(), draws.direction(), origin));
    }
  }
}

TEST(CameraRaster, IsExactFarFromTheObject) {
  const Scene scene = builtin_scene("asteroid");
  const RasterAndRays casters(scene);
  for (const double distance_m : {1e3, 1e4, 4e4}) {
    const RadialTangential lens{.k1 = 0.04 * distance_m * distance_m};
    const Pose pose = look_at({distance_m, 0.0, 0.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
    const Beams narrow = lens_beams(48, 40, 15.0 * distance_m, lens);
    EXPECT_GT(casters.expect_same(narrow, pose), 0U);
  }
}

TEST(CameraRaster, MissesPixelsWithoutABeam) {
  const Scene room = make_room();
  const RasterAndRays casters(room);
  Draws draws(8);
  for (Beams beams : cameras()) {
    for (std::size_t i = 0; i < beams.size(); ++i) {
      const bool is_corner = i / beams.cols < beams.rows / 3 && i % beams.cols < beams.cols / 2;
      if (draws.next() > 0.3 && !is_corner) continue;
      beams.directions[i].setConstant(kNaN);
    }
    EXPECT_GT(casters.expect_same(beams, turned(0.4, {1.0, 0.3, 0.2}, {0.0, 0.0, 0.2})), 0U);
  }
  Beams none = plain_beams(64, 48, 50.0);
  for (Eigen::Vector3d& d : none.directions) d.setConstant(kNaN);
  EXPECT_EQ(casters.expect_same(none, Pose::Identity()), 0U);
}

TEST(CameraRaster, EqualsRaysForDirectionsWithRandomErrors) {
  const Scene room = make_room();
  const RasterAndRays casters(room);
  Draws draws(9);
  for (const double error_px : {0.2, 1.0, 3.0}) {
    Beams beams = plain_beams(200, 150, 100.0);
    for (Eigen::Vector3d& d : beams.directions) {
      d = (d + error_px / 100.0 * draws.next() * draws.direction()).normalized();
    }
    // Here half of the image has random directions.
    for (std::size_t i = 0; i < beams.size() / 3; ++i) beams.directions[i] = draws.direction();
    if (error_px < 2.0) {
      EXPECT_GT(casters.expect_same(beams, Pose::Identity()), 0U);
    }
  }
}

TEST(CameraRaster, RejectsCamerasThatMoveOrHaveNoSmoothImage) {
  const Scene room = make_room();
  Draws draws(8);
  Beams random = plain_beams(64, 48, 50.0);
  for (Eigen::Vector3d& direction : random.directions) direction = draws.direction();
  Beams moving = plain_beams(64, 48, 50.0);
  moving.origins_m.assign(moving.size(), Eigen::Vector3d(0.1, 0.0, 0.0));
  Hits hits;
  for (const Beams& beams : {random, moving}) {
    EXPECT_THROW(make_renderer(room, {.kind = "raster"})->cast({.beams = beams}, hits), Error);
  }
}

}  // namespace
}  // namespace glidar
