// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Cameras by raster and by gpu: the results are those of rays, bit for bit; which beams a raster
// accepts.
#include <glidar/core/error.hpp>
#include <render/renderer_suite.hpp>
#include <render/same_hits.hpp>
#include <support/error_text.hpp>

#include <atomic>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;
using testing::expect_same_hits;
using testing::pinhole_beams;
using testing::turned;

class Rasterizer : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (GetParam() == std::string("gpu")) GLIDAR_NEEDS_GPU();
  }

  static Hits cast_by(const char* kind, const Scene& scene, const CastRequest& request) {
    Hits hits;
    make_renderer(scene, {.kind = kind, .threads = 2})->cast(request, hits);
    return hits;
  }

  /// Expects the bits of rays in every column; returns how many beams hit.
  static std::size_t expect_bits_of_rays(const Scene& scene, const CastRequest& request) {
    return expect_same_hits(cast_by(GetParam(), scene, request), cast_by("rays", scene, request));
  }

  static Hits draw(const Scene& scene, const Beams& beams, const Pose& pose) {
    return cast_by(GetParam(), scene,
                   {.beams = beams, .world_from_sensor = pose, .hit_columns = kAllHitColumns});
  }
};

TEST_P(Rasterizer, EqualsRaysOnADenseMesh) {
  const Scene scene = builtin_scene("asteroid");
  const Beams beams = camera_beams(400, 300, 500.0);
  const Pose pose = look_at({3.0, 1.0, 1.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const CastRequest request{
      .beams = beams, .world_from_sensor = pose, .hit_columns = kAllHitColumns};
  EXPECT_GT(expect_bits_of_rays(scene, request), 30'000U);
}

TEST_P(Rasterizer, EqualsRaysOnTheBunny) {
  GLIDAR_NEEDS_DATA();
  const Scene scene = testing::scene_of(testing::load_data_model("models/stanford/bun_zipper.ply"));
  const Eigen::Vector3d middle = bounds(scene).center();
  // From 5 km with triangles far smaller than a pixel, and from near with large ones.
  for (const double distance_m : {0.15, 0.4, 5.0, 5000.0}) {
    const Beams beams = camera_beams(300, 300, 1000.0 * distance_m);
    const Pose pose =
        look_at(middle + distance_m * Eigen::Vector3d(0.6, 0.0, 0.8), middle, {0.0, 1.0, 0.0});
    const CastRequest request{
        .beams = beams, .world_from_sensor = pose, .hit_columns = kAllHitColumns};
    EXPECT_GT(expect_bits_of_rays(scene, request), 10'000U) << distance_m;
  }
}

TEST_P(Rasterizer, DrawsImagesOfManyTiles) {
  const Scene scene = builtin_scene("torus");
  PinholeIntrinsics k{.width = 900, .height = 500, .fx = 3200.0, .fy = 1700.0};
  k.cx = 400.25;
  k.cy = 310.75;
  const Pose pose = look_at({4.0, 3.0, 2.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const Beams large = pinhole_beams(k);
  EXPECT_GT(expect_bits_of_rays(
                scene, {.beams = large, .world_from_sensor = pose, .hit_columns = kAllHitColumns}),
            40'000U);
}

TEST_P(Rasterizer, AcceptsAnyPrincipalPointFocalLengthsAndPixelCentre) {
  Scene scene = builtin_scene("asteroid");
  PinholeIntrinsics k{.width = 203, .height = 101, .fx = 311.7, .fy = 187.3};
  k.cx = -60.5;  // outside of the image
  k.cy = 140.25;
  for (const double centre : {0.0, 0.5}) {
    k.pixel_centre = centre;
    const Beams beams = pinhole_beams(k);
    scene.instances[0].world_from_object.translation() =
        5.0 * direction_through(plane_x(k, 100), plane_y(k, 50));
    const CastRequest request{.beams = beams, .hit_columns = kAllHitColumns};
    EXPECT_GT(expect_bits_of_rays(scene, request), 3'000U);
  }
}

TEST_P(Rasterizer, RendersSurfacesAtTheSensorAndTenKilometresAway) {
  Scene scene = builtin_scene("plane");
  add_model(scene, make_builtin_model("plane"));
  const double far_m = 1e4;
  scene.instances[0].scale = 0.01;
  scene.instances[0].world_from_object = turned(0.0, {1.0, 0.0, 0.0}, {0.0, 0.0, 0.1});
  scene.instances[1].scale = far_m;
  scene.instances[1].world_from_object = turned(0.1, {1.0, 0.0, 0.0}, {0.0, 0.0, far_m});
  const Beams beams = camera_beams(64, 64, 64.0);
  const Hits drawn = draw(scene, beams, Pose::Identity());
  std::size_t near_hits = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    ASSERT_NE(drawn.instance[i], kInvalidId) << "beam " << i;
    if (drawn.instance[i] == 1) continue;
    ++near_hits;
    EXPECT_NEAR(drawn.depth_m[i], 0.1, 1e-12);
  }
  EXPECT_GT(near_hits, 30U);
  EXPECT_LT(near_hits, 1000U);
}

TEST_P(Rasterizer, ResolvesThinLayersFromTenKilometres) {
  Scene scene = builtin_scene("plane");
  add_model(scene, make_builtin_model("plane"));
  // A surface 0.1 mm behind another: far below what single precision resolves of 10 km.
  scene.instances[0].world_from_object.translation().z() = 1e4 + 1e-4;
  scene.instances[1].world_from_object.translation().z() = 1e4;
  const Hits drawn = draw(scene, camera_beams(50, 50, 1e6), Pose::Identity());
  std::size_t found = 0;
  for (const std::uint32_t instance : drawn.instance) {
    if (instance == kInvalidId) continue;
    ++found;
    EXPECT_EQ(instance, 1U);
  }
  EXPECT_GT(found, 1000U);
}

TEST_P(Rasterizer, AlphaMasksOfSomeSlotsKeepTriangleIds) {
  Scene scene = builtin_scene("sphere");
  Mesh& mesh = scene.meshes[0];
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    mesh.material_slots.push_back(static_cast<std::uint16_t>(t % 3));  // alternate in the draw
  }
  scene.materials.resize(3, scene.materials[0]);
  scene.instances[0].materials = {0, 1, 2};
  scene.textures.push_back(
      {.name = "mask",
       .width = 4,
       .height = 4,
       .channels = 2,
       .texels = {9, 0,   9, 255, 9, 90, 9, 200, 9, 255, 9, 30,  9, 128, 9, 0,
                  9, 128, 9, 0,   9, 60, 9, 255, 9, 10,  9, 180, 9, 255, 9, 90}});
  scene.materials[1].alpha_cutoff = 0.5F;
  scene.materials[1].alpha_texture = {.texture = 0, .wrap_u = Wrap::mirror, .wrap_v = Wrap::repeat};
  scene.materials[1].alpha_texture.uv_scale_rotate << 3.0F, 1.0F, -1.0F, 5.0F;
  scene.materials[1].alpha_texture.uv_offset = {-0.3F, 0.2F};
  scene.materials[2].alpha_cutoff = 0.5F;
  scene.materials[2].opacity = 0.4F;  // all of it lets beams through
  const Beams beams = camera_beams(200, 200, 200.0);
  const Pose pose = look_at({2.0, 1.0, 1.5}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  const CastRequest request{
      .beams = beams, .world_from_sensor = pose, .hit_columns = kAllHitColumns};
  EXPECT_GT(expect_bits_of_rays(scene, request), 10'000U);
}

TEST_P(Rasterizer, DisabledInstancesAreNotDrawn) {
  Scene scene = builtin_scene("sphere");
  add_model(scene, make_builtin_model("sphere"));
  scene.instances[0].world_from_object.translation().z() = 4.0;
  scene.instances[1].world_from_object.translation().z() = 9.0;
  const Beams beams = camera_beams(16, 16, 60.0);
  const auto middle = [&](std::vector<std::uint8_t> present) {
    return cast_by(GetParam(), scene,
                   {.beams = beams, .hit_columns = {}, .instance_enabled = present})
        .instance[8 * 16 + 8];
  };
  EXPECT_EQ(middle({}), 0U);
  EXPECT_EQ(middle({0, 1}), 1U);
  EXPECT_EQ(middle({0, 0}), kInvalidId);
}

TEST_P(Rasterizer, BeamsExactlyAtVerticesAndAlongEdgesDoNotLeak) {
  // A rough surface in front of a far one, with vertices at beams and half-way between.
  Scene scene = builtin_scene("plane");
  scene.instances[0].scale = 100.0;
  scene.instances[0].world_from_object.translation().z() = 50.0;
  const int side = 80;
  const double focal_px = 64.0;
  Mesh surface;
  for (int row = 0; row <= side; ++row) {
    for (int col = 0; col <= side; ++col) {
      const double depth = 4.0 + ((row * 7 + col * 13) % 5) / 8.0;
      const Eigen::Vector2d at = Eigen::Vector2d(col - side / 2, row - side / 2) / (2.0 * focal_px);
      surface.positions_m.push_back((depth * at.homogeneous()).cast<float>());
    }
  }
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col) {
      const auto at = static_cast<std::uint32_t>(row * (side + 1) + col);
      const std::uint32_t below = at + side + 1;
      surface.triangles.push_back({at, at + 1, below});
      surface.triangles.push_back({below, at + 1, below + 1});
    }
  }
  const std::uint32_t triangles = static_cast<std::uint32_t>(surface.triangles.size());
  scene.meshes.push_back(std::move(surface));
  scene.sources.push_back({});
  scene.instances.push_back(
      {.name = "surface", .mesh = 1, .materials = scene.instances[0].materials});
  PinholeIntrinsics k{.width = 39, .height = 39, .fx = focal_px, .fy = focal_px};
  k.cx = k.cy = 19.0;
  k.pixel_centre = 0.0;
  const Hits hits = draw(scene, pinhole_beams(k), Pose::Identity());
  for (std::size_t i = 0; i < hits.instance.size(); ++i) {
    EXPECT_EQ(hits.instance[i], 1U) << i;
    EXPECT_LT(hits.primitive[i], triangles);
  }
}

TEST_P(Rasterizer, ReportsEveryBeamOnceAndItsProgress) {
  const Scene scene = builtin_scene("torus");
  const Beams beams = camera_beams(70, 50, 60.0);
  const Pose away = turned(3.1, {0.0, 1.0, 0.0}, {0.0, 0.0, -5.0});
  for (const Pose& pose : {turned(0.0, {0.0, 1.0, 0.0}, {0.0, 0.0, -5.0}), away}) {
    std::vector<std::atomic<int>> report_count(beams.size());
    const auto count = [&](BeamRange range) {
      for (std::size_t i = range.begin; i < range.end; ++i) ++report_count[i];
    };
    double progress = 0.0;
    cast_by(GetParam(), scene,
            {.beams = beams,
             .world_from_sensor = pose,
             .hit_columns = {},
             .on_tile_done = FunctionRef<void(BeamRange)>(count),
             .progress = [&](double part) { progress = part; }});
    for (const std::atomic<int>& times : report_count) EXPECT_EQ(times, 1);
    EXPECT_EQ(progress, 1.0);
  }
}

TEST(Raster, RejectsBeamsThatItCannotDraw) {
  const Scene scene = builtin_scene("box");
  Beams beams = camera_beams(4, 4, 4.0);
  const auto refusal = [&](const std::string& found) {
    Hits hits;
    const auto raster = make_renderer(scene, {.kind = "raster", .threads = 1});
    const std::string text = error_text([&] { raster->cast({.beams = beams}, hits); });
    EXPECT_EQ(text, "raster renderer: " + found +
                        "; allowed: a pinhole camera at rest, without distortion and with beams "
                        "from one point; use --renderer rays");
  };
  beams.origins_m.assign(16, Eigen::Vector3d::Zero());
  refusal("beams with origins of their own");
  beams.origins_m.clear();
  beams.pinhole.reset();
  refusal("beams that are not a pinhole's straight grid");
}

INSTANTIATE_TEST_SUITE_P(All, Rasterizer, ::testing::Values("raster", "gpu"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace glidar
