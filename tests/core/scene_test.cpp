// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/math/constants.hpp>
#include <support/error_text.hpp>

#include <gtest/gtest.h>

#include <functional>

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

}  // namespace
}  // namespace glidar
