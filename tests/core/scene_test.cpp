// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>

#include <glidar/core/material.hpp>
#include <glidar/core/mesh.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/math/constants.hpp>

#include <gtest/gtest.h>
#include <support/error_text.hpp>

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace glidar {
namespace {

Mesh triangle() {
  Mesh mesh;
  mesh.name = "t";
  mesh.origin_m = {10.0, 0.0, 0.0};
  mesh.positions_m = {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 2.0F, 0.0F}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

Scene one_triangle() {
  Scene scene;
  scene.meshes.push_back(triangle());
  scene.sources.emplace_back();
  scene.materials.emplace_back();
  scene.instances.push_back({.name = "i", .materials = {0}});
  return scene;
}

std::string error_of(const std::function<void(Scene&)>& spoil) {
  Scene scene = one_triangle();
  spoil(scene);
  return error_text([&] { validate(scene); });
}

TEST(MeshBounds, IncludeTheOrigin) {
  const Eigen::AlignedBox3d box = bounds(triangle());
  EXPECT_EQ(box.min(), Eigen::Vector3d(10.0, 0.0, 0.0));
  EXPECT_EQ(box.max(), Eigen::Vector3d(11.0, 2.0, 0.0));
  EXPECT_TRUE(bounds(Mesh{}).isEmpty());
}

TEST(SceneBounds, IncludePoseAndScale) {
  Scene scene = one_triangle();
  scene.instances[0].scale = 2.0;
  scene.instances[0].world_from_object.translation() = Eigen::Vector3d(0.0, 0.0, 5.0);
  EXPECT_EQ(bounds(scene).min(), Eigen::Vector3d(20.0, 0.0, 5.0));
  EXPECT_EQ(bounds(scene).max(), Eigen::Vector3d(22.0, 4.0, 5.0));
  EXPECT_TRUE(bounds(Scene{}).isEmpty());
}

TEST(SceneValidate, AcceptsAValidScene) {
  EXPECT_EQ(error_of([](Scene&) {}), "no error");
}

/// The triangle with this corner instead of the one farthest from its origin.
std::string error_of_reach(float reach, double scale) {
  return error_of([=](Scene& s) {
    s.meshes[0].origin_m.setZero();
    s.meshes[0].positions_m = {{0.0F, 0.0F, 0.0F}, {reach, 0.0F, 0.0F}, {0.0F, -reach, 0.0F}};
    s.instances[0].scale = scale;
  });
}

TEST(SceneValidate, LimitsTheDistanceOfVerticesFromTheOrigin) {
  EXPECT_EQ(error_of_reach(0.0F, 1.0), "no error");
  for (const double scale : {kMinScale, 1.0, 1e6}) {
    const auto most = static_cast<float>(0.9 * kMaxCoordinate_m / scale);
    const auto least = static_cast<float>(1.1 * kMinReach_m / scale);
    for (const float reach : {most, least}) EXPECT_EQ(error_of_reach(reach, scale), "no error");
    for (const float reach : {2.0F * most, 0.5F * least}) {
      EXPECT_NE(error_of_reach(reach, scale), "no error") << reach << " at scale " << scale;
    }
  }
  EXPECT_EQ(error_of_reach(0x1p100F, 1.0),
            "instance 'i': its vertices reach 1.2676506002282294e+30 m from its origin; allowed: "
            "1e-30 m to 1e15 m; choose another unit or scale, or an origin nearer to the vertices");
}

TEST(SceneValidate, ReportsTheInvalidField) {
  EXPECT_EQ(error_of([](Scene& s) { s.instances[0].scale = 0.0; }),
            "instance 'i': scale 0; allowed: 1e-15 to 1e15; choose another unit or scale");
  EXPECT_EQ(error_of([](Scene& s) { s.instances[0].mesh = 1; }),
            "instance 'i': mesh 1; allowed: an index of the scene's meshes");
  EXPECT_EQ(error_of([](Scene& s) { s.instances[0].world_from_object.linear()(0, 0) = 3.0; }),
            "instance 'i': a pose that is not a rigid transform; allowed: finite numbers and a "
            "rotation");
  EXPECT_EQ(error_of([](Scene& s) { s.instances[0].materials = {}; }),
            "instance 'i': 0 materials; allowed: one per material slot");
  EXPECT_EQ(error_of([](Scene& s) { s.instances[0].class_id = 4; }),
            "instance 'i': class 4; allowed: an index of the scene's class names");
  EXPECT_EQ(error_of([](Scene& s) { s.materials[0].alpha_texture.texture = 2; }),
            "material 'default': texture 2; allowed: an index of the scene's textures");
  EXPECT_EQ(error_of([](Scene& s) { s.materials[0].diffuse_texture.uv_set = 2; }),
            "material 'default': uv set 2; allowed: 0 or 1");
  EXPECT_EQ(error_of([](Scene& s) { s.textures.emplace_back().name = "t"; }),
            "texture 't': 0 bytes, 0 x 0 texels; allowed: width x height x channels bytes, 1 to 4 "
            "channels, "
            "1 to 2^30 texels");
  EXPECT_EQ(error_of([](Scene& s) { s.sources.clear(); }),
            "scene, sources: 0 entries; allowed: 1 (one per mesh)");
  EXPECT_EQ(error_of([](Scene& s) { s.instances[0].world_from_object.translation().x() = 1e30; }),
            "instance 'i': a position too far away; allowed: up to 1e15 m from the world's origin; "
            "move the world's origin nearer to it");
  EXPECT_EQ(error_of([](Scene& s) { s.meshes[0].triangles[0][1] = 3; }),
            "mesh 't', triangles: a corner is vertex 3; allowed: below 3");
  EXPECT_EQ(error_of([](Scene& s) { s.meshes[0].normals.resize(2); }),
            "mesh 't', normals: 2 entries; allowed: 0 or 3");
  EXPECT_EQ(error_of([](Scene& s) { s.meshes[0].positions_m[0].x() = kNaNf; }),
            "mesh 't', positions_m: a coordinate is not finite; allowed: finite metres");
}

/// Three triangles in three ranges, the first and the last with the same origin.
Mesh three_runs() {
  Mesh mesh;
  mesh.name = "runs";
  const Eigen::Vector3d far(1e4, 0.0, -1e4);
  mesh.origins = {{0, 0, {1.0, 2.0, 3.0}}, {3, 1, far}, {6, 2, {1.0, 2.0, 3.0}}};
  for (int run = 0; run < 3; ++run) {
    const auto x = static_cast<float>(run);
    mesh.positions_m.insert(mesh.positions_m.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}});
    const auto first = static_cast<std::uint32_t>(3 * run);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.material_slots.push_back(static_cast<std::uint16_t>(run));
    mesh.normals.insert(mesh.normals.end(), 3, Eigen::Vector3f::UnitZ());
  }
  return mesh;
}

TEST(MeshOrigins, EveryVertexIsRelativeToTheOriginOfItsRange) {
  const Mesh mesh = three_runs();
  EXPECT_NO_THROW(validate(mesh));
  EXPECT_EQ(vertex_m(mesh, 1), Eigen::Vector3d(2.0, 2.0, 3.0));
  EXPECT_EQ(vertex_m(mesh, 3), Eigen::Vector3d(10001.0, 0.0, -1e4));
  EXPECT_EQ(vertex_m(mesh, 8), Eigen::Vector3d(3.0, 3.0, 3.0));
  EXPECT_EQ(bounds(mesh).min(), Eigen::Vector3d(1.0, 0.0, -1e4));
  EXPECT_EQ(bounds(mesh).max(), Eigen::Vector3d(10002.0, 3.0, 3.0));
}

TEST(MeshOrigins, WithoutRangesOneOriginApplies) {
  Mesh mesh = three_runs();
  mesh.origins.clear();
  mesh.origin_m = {5.0, 0.0, 0.0};
  EXPECT_EQ(vertex_m(mesh, 8), Eigen::Vector3d(7.0, 1.0, 0.0));
}

TEST(MeshOrigins, InvalidRangesAreErrors) {
  const std::vector<void (*)(Mesh&)> harms = {[](Mesh& m) { m.origins[0].first_vertex = 1; },
                                              [](Mesh& m) { m.origins[0].first_triangle = 1; },
                                              [](Mesh& m) { m.origins[1].first_vertex = 4; },
                                              [](Mesh& m) { m.origins[1].first_triangle = 3; },
                                              [](Mesh& m) { m.origins[2].first_vertex = 10; },
                                              [](Mesh& m) { m.origins[1].origin_m.x() = NAN; },
                                              [](Mesh& m) { m.triangles[2][0] = 0; }};
  for (std::size_t i = 0; i < harms.size(); ++i) {
    Mesh mesh = three_runs();
    harms[i](mesh);
    EXPECT_THROW(validate(mesh), Error) << i;
  }
}

TEST(MeshPieces, ContainTheRangesOfOneOriginWithTrianglesInOrder) {
  const Mesh mesh = three_runs();
  const std::vector<MeshPiece> pieces = cut_at_origins(mesh);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].triangles, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(pieces[1].triangles, (std::vector<std::uint32_t>{1}));
  for (const MeshPiece& piece : pieces) {
    EXPECT_NO_THROW(validate(piece.mesh));
    for (std::size_t t = 0; t < piece.triangles.size(); ++t) {
      const std::uint32_t whole = piece.triangles[t];
      EXPECT_EQ(piece.mesh.material_slots[t], mesh.material_slots[whole]);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(vertex_m(piece.mesh, piece.mesh.triangles[t][k]),
                  vertex_m(mesh, mesh.triangles[whole][k]));
      }
    }
  }
  EXPECT_TRUE(cut_at_origins(Mesh{}).empty());
}

/// Two by two grey texels: top row 0 51, bottom row 102 255.
std::vector<Texture> grey() {
  return {{.name = "grey", .width = 2, .height = 2, .channels = 1, .texels = {0, 51, 102, 255}}};
}

float grey_at(const TextureUse& use, float u, float v) {
  return sample(use, grey(), {u, v}).x() * 255.0F;
}

TEST(Sample, HasVUpwardsAndTexelCentresAtHalves) {
  const TextureUse use{.texture = 0, .filter = Filter::nearest};
  EXPECT_FLOAT_EQ(grey_at(use, 0.25F, 0.75F), 0.0F);
  EXPECT_FLOAT_EQ(grey_at(use, 0.75F, 0.75F), 51.0F);
  EXPECT_FLOAT_EQ(grey_at(use, 0.25F, 0.25F), 102.0F);
  EXPECT_FLOAT_EQ(grey_at(use, 0.75F, 0.25F), 255.0F);
}

TEST(Sample, InterpolatesBetweenCentres) {
  const TextureUse use{.texture = 0, .wrap_u = Wrap::clamp, .wrap_v = Wrap::clamp};
  EXPECT_FLOAT_EQ(grey_at(use, 0.25F, 0.75F), 0.0F);
  EXPECT_NEAR(grey_at(use, 0.5F, 0.75F), 25.5F, 1e-4F);
  EXPECT_NEAR(grey_at(use, 0.5F, 0.5F), (0.0F + 51.0F + 102.0F + 255.0F) / 4.0F, 1e-4F);
}

TEST(Sample, WrapsRepeatsAndMirrors) {
  TextureUse use{.texture = 0, .filter = Filter::nearest};
  EXPECT_FLOAT_EQ(grey_at(use, 1.25F, 0.75F), 0.0F);
  EXPECT_FLOAT_EQ(grey_at(use, -0.25F, 0.75F), 51.0F);
  use.wrap_u = Wrap::mirror;
  EXPECT_FLOAT_EQ(grey_at(use, 1.25F, 0.75F), 51.0F);
  EXPECT_FLOAT_EQ(grey_at(use, -0.25F, 0.75F), 0.0F);
  use.wrap_u = Wrap::clamp;
  EXPECT_FLOAT_EQ(grey_at(use, 7.0F, 0.75F), 51.0F);
  EXPECT_FLOAT_EQ(grey_at(use, -7.0F, 0.75F), 0.0F);
}

TEST(Sample, AppliesTheUvTransform) {
  TextureUse use{.texture = 0, .filter = Filter::nearest};
  use.uv_scale_rotate = 2.0F * Eigen::Matrix2f::Identity();
  use.uv_offset = {0.5F, 0.0F};
  EXPECT_FLOAT_EQ(grey_at(use, 0.125F, 0.375F), 51.0F);  // looked up at 0.75, 0.75
}

TEST(Sample, CopiesGreyToRgbAndKeepsAlpha) {
  const std::vector<Texture> textures = {
      {.name = "ga", .width = 1, .height = 1, .channels = 2, .texels = {51, 102}}};
  const Eigen::Vector4f found = sample({.texture = 0}, textures, {0.5F, 0.5F});
  EXPECT_TRUE(found.isApprox(Eigen::Vector4f(0.2F, 0.2F, 0.2F, 0.4F)));
}

TEST(Sample, SurvivesHugeAndUndefinedCoordinates) {
  const TextureUse use{.texture = 0};
  const float nan = kNaNf;
  EXPECT_TRUE(sample(use, grey(), {1e30F, -1e30F}).allFinite());
  EXPECT_EQ(sample(use, grey(), {nan, 0.0F}), Eigen::Vector4f::Ones());
}

TEST(OpacityAt, IsAlphaOrElseGrey) {
  Material material;
  material.opacity = 0.5F;
  EXPECT_FLOAT_EQ(opacity_at(material, grey(), {0.75F, 0.25F}), 0.5F);
  material.alpha_texture = {.texture = 0, .filter = Filter::nearest};
  EXPECT_FLOAT_EQ(opacity_at(material, grey(), {0.25F, 0.25F}), 0.2F);
}

}  // namespace

}  // namespace glidar
