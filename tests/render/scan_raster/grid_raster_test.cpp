// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Promises of the raster that hold for cameras with lenses and for scanners.
#include <glidar/render/rays/kernels.hpp>
#include <render/scan_raster/scanner.hpp>
#include <render/scan_raster/scenes.hpp>

#include <cstdlib>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::cast_with;
using testing::Draws;
using testing::expect_same_as_rays;
using testing::expect_same_hits;
using testing::lens_beams;
using testing::make_room;
using testing::make_soup;
using testing::RasterAndRays;
using testing::scanner_beams;
using testing::turned;

const Pose kInRoom = turned(0.0, {0.0, 0.0, 1.0}, {0.0, 0.0, 0.2});

struct GridCase {
  const char* name;
  Beams beams;
  Eigen::Matrix3d world_from_forward;  ///< its boresight along +x
};

void PrintTo(const GridCase& one, std::ostream* out) {
  *out << one.name;
}

class GridRaster : public ::testing::TestWithParam<GridCase> {
 protected:
  const Beams& beams() const { return GetParam().beams; }
  /// The sensor at this x, looking along +x.
  Pose on_x_axis(double x_m) const {
    Pose pose = Pose::Identity();
    pose.linear() = GetParam().world_from_forward;
    pose.translation().x() = x_m;
    return pose;
  }
  /// The room, and its renderers.
  static const Scene& room() {
    static const Scene kRoom = make_room();
    return kRoom;
  }
  static const RasterAndRays& room_casters() {
    static const RasterAndRays kCasters(room());
    return kCasters;
  }
};

TEST_P(GridRaster, EqualsRaysInTriangleSoups) {
  Draws draws(5);
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const double size_m = std::pow(10.0, 4.0 * draws.next() - 2.0);
    const Scene scene = make_soup(seed, 400, size_m);
    const Eigen::Vector3d origin = size_m * draws.direction() * draws.next();
    expect_same_as_rays(scene, beams(), turned(6.0 * draws.next(), draws.direction(), origin));
  }
}

TEST_P(GridRaster, EqualsRaysFromVerticesAndInPlanesOfTriangles) {
  for (const Instance& instance : room().instances) {
    const Mesh& mesh = room().meshes[instance.mesh];
    for (const std::size_t k : {std::size_t{0}, mesh.positions_m.size() / 2}) {
      const Eigen::Vector3d vertex =
          instance.world_from_object * (instance.scale * mesh.positions_m[k].cast<double>());
      room_casters().expect_same(beams(), turned(0.0, {0.0, 0.0, 1.0}, vertex));
      room_casters().expect_same(beams(), turned(1.0, {1.0, 0.0, 1.0}, vertex));
    }
  }
  const Scene scene = builtin_scene("box");
  const RasterAndRays box(scene);  // beams run in the planes of its sides
  box.expect_same(beams(), turned(0.0, {0.0, 0.0, 1.0}, {1.0, 0.2, -3.0}));
  box.expect_same(beams(), turned(0.0, {0.0, 0.0, 1.0}, {-3.0, 0.2, 1.0}));
}

TEST_P(GridRaster, FindsTheLowestOfCoincidentSurfacesOfManyInstances) {
  Scene scene = builtin_scene("torus");
  const Pose pose = turned(0.7, {0.3, 0.2, 1.0}, {0.1, 0.0, 0.0});
  for (int i = 0; i < 20; ++i) {
    scene.instances.push_back(scene.instances[0]);
    scene.instances.back().world_from_object = i % 3 == 0 ? Pose::Identity() : pose;
    scene.instances.back().scale = i % 3 == 1 ? 1.0 + 1e-15 : 1.0;
  }
  const RasterAndRays casters(scene);
  for (const double x_m : {-1.0, -3.0}) {
    EXPECT_GT(casters.expect_same(beams(), on_x_axis(x_m)), 0U);
  }
}

TEST_P(GridRaster, IsExactFarFromTheWorldsOriginAndForAllScales) {
  Scene scene = builtin_scene("asteroid");
  for (const double scale : {1e9, 1e-9}) {
    scene.instances[0].scale = scale;
    expect_same_as_rays(scene, beams(), on_x_axis(-1.5 * scale));
  }
  const Eigen::Vector3d offset(1e9, -2e9, 5e8);
  scene.instances[0].scale = 1.0;
  scene.instances[0].world_from_object.translation() = offset;
  const Pose pose = turned(0.4, {0.0, 1.0, 2.0}, offset + Eigen::Vector3d(0.1, 0.2, 0.0));
  EXPECT_GT(expect_same_as_rays(scene, beams(), pose), 0U);
}

TEST_P(GridRaster, CullsBackFacesAndAppliesAlphaMasks) {
  std::size_t hits = 0;
  for (const Pose& pose : {kInRoom, on_x_axis(0.0), on_x_axis(-3.0)}) {
    hits += room_casters().expect_same({.beams = beams(),
                                        .world_from_sensor = pose,
                                        .hit_columns = kAllHitColumns,
                                        .cull_back_faces = true});
  }
  EXPECT_GT(hits, 0U);
  Scene masked = room();
  for (Material& material : masked.materials) material.alpha_cutoff = 0.5F;
  expect_same_as_rays(masked, beams(), kInRoom);
}

TEST_P(GridRaster, EqualsRaysForRepeatedRows) {
  Beams twice = beams();
  for (auto* column : {&twice.directions, &twice.origins_m}) {
    const std::vector<Eigen::Vector3d> once = *column;
    column->insert(column->end(), once.begin(), once.end());
  }
  twice.rows *= 2;
  twice.returns = 2;
  EXPECT_GT(room_casters().expect_same(twice, kInRoom), 0U);
}

TEST_P(GridRaster, ReportsEveryBeamOnceAndAllProgress) {
  std::vector<int> reported(beams().size(), 0);
  double progress = 0.0;
  const auto count = [&](BeamRange range) {
    for (std::size_t i = range.begin; i < range.end; ++i) ++reported[i];
  };
  Hits hits;
  make_renderer(room(), {.kind = "raster", .threads = 1})
      ->cast({.beams = beams(),
              .world_from_sensor = kInRoom,
              .on_tile_done = FunctionRef<void(BeamRange)>(count),
              .progress = [&](double part) { progress = part; }},
             hits);
  EXPECT_EQ(reported, std::vector<int>(beams().size(), 1));
  EXPECT_EQ(progress, 1.0);
}

TEST_P(GridRaster, DetectsBeamsThatChangedInPlace) {
  Beams changing = beams();
  const auto raster = make_renderer(room(), {.kind = "raster", .threads = 2});
  for (int k = 0; k < 3; ++k) {
    const CastRequest request{
        .beams = changing, .world_from_sensor = kInRoom, .hit_columns = kAllHitColumns};
    Hits hits;
    raster->cast(request, hits);
    EXPECT_GT(expect_same_hits(hits, cast_with("rays", room(), request)), 0U);
    const Eigen::Matrix3d turn = turned(0.1, {0.1, 0.0, 1.0}, {0.0, 0.0, 0.0}).linear();
    for (Eigen::Vector3d& direction : changing.directions) {
      direction = (turn * direction).normalized();
    }
  }
}

TEST_P(GridRaster, HasTheSameBitsWithEveryInstructionSet) {
  const CastRequest request{
      .beams = beams(), .world_from_sensor = kInRoom, .hit_columns = kAllHitColumns};
  const Hits expected = cast_with("rays", room(), request);
  for (const rays::Kernel* kernel : rays::usable_kernels()) {
    setenv("GLIDAR_ISA", kernel->name, 1);
    expect_same_hits(cast_with("raster", room(), request), expected);
  }
  unsetenv("GLIDAR_ISA");
}

GridCase camera_case(const char* name, const Distortion& distortion) {
  return {name, lens_beams(171, 130, 100.0, distortion), optical_from_body().inverse().linear()};
}

INSTANTIATE_TEST_SUITE_P(
    , GridRaster,
    ::testing::Values(
        camera_case("lens", RadialTangential{.k1 = -0.28, .k2 = 0.07}),
        camera_case("fisheye", Fisheye{.k1 = 0.1}),
        GridCase{"scanner",
                 scanner_beams({.rows = 18, .cols = 300, .high_rad = 1.5, .stagger_rad = 0.04}),
                 Eigen::Matrix3d::Identity()},
        GridCase{"scanner_with_origins",
                 scanner_beams({.rows = 16, .cols = 300, .uneven = 0.3, .origin_m = 0.05}),
                 Eigen::Matrix3d::Identity()}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace glidar
