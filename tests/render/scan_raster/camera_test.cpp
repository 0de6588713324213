// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The raster returns the same bits as rays for cameras with any lens.
#include <glidar/render/rays/kernels.hpp>

#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/sensor/optics/pinhole.hpp>
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
using testing::turned;

Beams lens_beams(std::uint32_t width, std::uint32_t height, double focal_px,
                 const Distortion& distortion) {
  return make_beams(Pinhole{.intrinsics = {.width = width,
                                           .height = height,
                                           .fx = focal_px,
                                           .fy = 1.1 * focal_px,
                                           .cx = 0.45 * width,
                                           .cy = 0.55 * height},
                            .distortion = distortion});
}

/// A pinhole without stored intrinsics.
Beams plain_beams(std::uint32_t width, std::uint32_t height, double focal_px) {
  Beams beams = testing::camera_beams(width, height, focal_px);
  beams.pinhole.reset();
  return beams;
}

Beams preset_beams(const char* name) {
  return make_beams(load_sensor_file(find_sensor_file(name)));
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
    for (const Beams& beams : all) {
      expect_same_as_rays(scene, beams, Pose::Identity());
      expect_same_as_rays(scene, beams, turned(1.0, {1.0, 2.0, 3.0}, {0.6, 0.05, 0.02}));
      const Pose outside = look_at({2.0, 1.0, 0.9}, {0.6, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
      EXPECT_GT(expect_same_as_rays(scene, beams, outside), 0U);
    }
  }
}

TEST(CameraRaster, EqualsRaysForAllDistortingPresets) {
  const Scene room = make_room();
  for (const char* name : {"Azure-Kinect-NFOV", "Azure-Kinect-NFOV-2x2", "Azure-Kinect-WFOV",
                           "Azure-Kinect-WFOV-2x2", "Kinect-v2"}) {
    const Beams beams = preset_beams(name);
    EXPECT_GT(expect_same_as_rays(room, beams, turned(0.7, {1.0, 1.0, 0.3}, {-0.5, 0.3, 0.4})),
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
    for (const Beams& beams : all) {
      const Eigen::Vector3d origin = size_m * draws.direction() * draws.next();
      expect_same_as_rays(scene, beams, turned(6.0 * draws.next(), draws.direction(), origin));
    }
  }
}

TEST(CameraRaster, EqualsRaysFromVerticesAndInPlanesOfTriangles) {
  const Scene room = make_room();
  const Beams beams = lens_beams(97, 80, 50.0, RadialTangential{.k1 = -0.2, .k2 = 0.03});
  for (const Instance& instance : room.instances) {
    const Mesh& mesh = room.meshes[instance.mesh];
    for (const std::size_t k : {std::size_t{0}, mesh.positions_m.size() / 2}) {
      const Eigen::Vector3d vertex =
          instance.world_from_object * (instance.scale * mesh.positions_m[k].cast<double>());
      expect_same_as_rays(room, beams, turned(0.0, {0.0, 0.0, 1.0}, vertex));
      expect_same_as_rays(room, beams, turned(1.0, {1.0, 0.0, 1.0}, vertex));
    }
  }
  expect_same_as_rays(builtin_scene("box"), beams, turned(0.0, {0.0, 0.0, 1.0}, {1.0, 0.2, -3.0}));
}

TEST(CameraRaster, FindsTheLowestOfCoincidentSurfacesOfManyInstances) {
  Scene scene = builtin_scene("torus");
  const Pose pose = turned(0.7, {0.3, 0.2, 1.0}, {0.1, 0.0, 0.0});
  for (int i = 0; i < 20; ++i) {
    scene.instances.push_back(scene.instances[0]);
    scene.instances.back().world_from_object = i % 3 == 0 ? Pose::Identity() : pose;
    scene.instances.back().scale = i % 3 == 1 ? 1.0 + 1e-15 : 1.0;
  }
  const Pose from = look_at({2.0, 0.3, 0.1}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  for (const Beams& beams : cameras()) expect_same_as_rays(scene, beams, from);
}

TEST(CameraRaster, IsExactFarFromTheWorldsOriginAndFromTheObject) {
  const Scene near = builtin_scene("asteroid");
  Scene far = near;
  const Eigen::Vector3d offset(1e9, -2e9, 5e8);
  far.instances[0].world_from_object.translation() = offset;
  const Beams beams = lens_beams(120, 90, 80.0, RadialTangential{.k1 = -0.2});
  const Pose pose = turned(0.4, {0.0, 1.0, 2.0}, offset + Eigen::Vector3d(0.1, 0.2, 0.0));
  EXPECT_GT(expect_same_as_rays(far, beams, pose), 0U);
  const auto at = [](double distance_m) {
    return look_at({distance_m, 0.0, 0.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  };
  for (const double distance_m : {1e3, 1e4, 4e4}) {
    const RadialTangential lens{.k1 = 0.04 * distance_m * distance_m};
    const Beams narrow = lens_beams(48, 40, 15.0 * distance_m, lens);
    EXPECT_GT(expect_same_as_rays(near, narrow, at(distance_m)), 0U);
  }
  Scene huge = near;
  huge.instances[0].scale = 1e9;
  expect_same_as_rays(huge, beams, at(1.5e9));
  huge.instances[0].scale = 1e-9;
  expect_same_as_rays(huge, beams, at(1.5e-9));
}

TEST(CameraRaster, CullsBackFacesAndAppliesAlphaMasks) {
  const Beams beams = lens_beams(120, 90, 60.0, Fisheye{.k1 = 0.1});
  Scene room = make_room();
  const Pose pose = turned(0.0, {0.0, 0.0, 1.0}, {0.0, 0.0, 0.2});
  expect_same_as_rays(room, {.beams = beams,
                             .world_from_sensor = pose,
                             .hit_columns = kAllHitColumns,
                             .cull_back_faces = true});
  for (Material& material : room.materials) material.alpha_cutoff = 0.5F;
  expect_same_as_rays(room, beams, pose);
}

TEST(CameraRaster, MissesPixelsWithoutABeam) {
  const Scene room = make_room();
  Draws draws(8);
  for (Beams beams : cameras()) {
    for (std::size_t i = 0; i < beams.size(); ++i) {
      const bool is_corner = i / beams.cols < beams.rows / 3 && i % beams.cols < beams.cols / 2;
      if (draws.next() > 0.3 && !is_corner) continue;
      beams.directions[i].setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    EXPECT_GT(expect_same_as_rays(room, beams, turned(0.4, {1.0, 0.3, 0.2}, {0.0, 0.0, 0.2})), 0U);
  }
  Beams none = plain_beams(64, 48, 50.0);
  for (Eigen::Vector3d& d : none.directions)
    d.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(expect_same_as_rays(room, none, Pose::Identity()), 0U);
}

TEST(CameraRaster, EqualsRaysForDirectionsWithRandomErrors) {
  const Scene room = make_room();
  Draws draws(9);
  for (const double error_px : {0.2, 1.0, 3.0}) {
    Beams beams = plain_beams(200, 150, 100.0);
    for (Eigen::Vector3d& d : beams.directions) {
      d = (d + error_px / 100.0 * draws.next() * draws.direction()).normalized();
    }
    // Here half of the image has random directions.
    for (std::size_t i = 0; i < beams.size() / 3; ++i) beams.directions[i] = draws.direction();
    if (error_px < 2.0) {
      EXPECT_GT(expect_same_as_rays(room, beams, Pose::Identity()), 0U);
    }
  }
}

TEST(CameraRaster, EqualsRaysForRepeatedRows) {
  Beams beams = lens_beams(100, 70, 60.0, Fisheye{});
  const std::vector<Eigen::Vector3d> once = beams.directions;
  beams.directions.insert(beams.directions.end(), once.begin(), once.end());
  beams.rows *= 2;
  beams.returns = 2;
  EXPECT_GT(expect_same_as_rays(make_room(), beams, Pose::Identity()), 0U);
}

TEST(CameraRaster, ReportsEveryBeamOnceAndAllProgress) {
  const Scene room = make_room();
  const Beams beams = lens_beams(171, 130, 100.0, RadialTangential{.k1 = -0.28, .k2 = 0.07});
  std::vector<int> reported(beams.size(), 0);
  double progress = 0.0;
  const auto count = [&](BeamRange range) {
    for (std::size_t i = range.begin; i < range.end; ++i) ++reported[i];
  };
  Hits hits;
  make_renderer(room, {.kind = "raster", .threads = 1})
      ->cast({.beams = beams,
              .on_tile_done = FunctionRef<void(BeamRange)>(count),
              .progress = [&](double part) { progress = part; }},
             hits);
  EXPECT_EQ(reported, std::vector<int>(beams.size(), 1));
  EXPECT_EQ(progress, 1.0);
}

TEST(CameraRaster, DetectsBeamsThatChangedInPlace) {
  const Scene room = make_room();
  Beams beams = lens_beams(100, 70, 60.0, Fisheye{});
  const auto raster = make_renderer(room, {.kind = "raster", .threads = 2});
  for (int k = 0; k < 3; ++k) {
    const CastRequest request{.beams = beams, .hit_columns = kAllHitColumns};
    Hits hits;
    raster->cast(request, hits);
    EXPECT_GT(expect_same_hits(hits, cast_with("rays", room, request)), 0U);
    const Eigen::Matrix3d turn = turned(0.1, {0.1, 0.0, 1.0}, {0.0, 0.0, 0.0}).linear();
    for (Eigen::Vector3d& direction : beams.directions) direction = (turn * direction).normalized();
  }
}

TEST(CameraRaster, HasTheSameBitsWithEveryInstructionSet) {
  const Scene room = make_room();
  const Beams beams = preset_beams("Azure-Kinect-NFOV-2x2");
  const CastRequest request{.beams = beams, .hit_columns = kAllHitColumns};
  const Hits expected = cast_with("rays", room, request);
  for (const rays::Kernel* kernel : rays::usable_kernels()) {
    setenv("GLIDAR_ISA", kernel->name, 1);
    expect_same_hits(cast_with("raster", room, request), expected);
  }
  unsetenv("GLIDAR_ISA");
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
