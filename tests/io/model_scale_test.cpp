// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Scales along the axes of a model.
#include <glidar/core/error.hpp>
#include <glidar/io/config/scene_file.hpp>
#include <glidar/io/model/builtin_models.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

TEST(SceneFile, InstancesWithEqualFactorsShareAScaledMesh) {
  const Scene scene = parse_scene(R"(models:
  - {model: 'builtin:box'}
  - {model: 'builtin:box', scale: [1, 2, 3]}
  - {model: 'builtin:box', scale: [1, 2, 3]}
  - {model: 'builtin:box', scale: [2, 2, 2]}
  - {model: 'builtin:box', scale: [1, 2, 4]}
)",
                                  {})
                          .scene;
  ASSERT_EQ(scene.meshes.size(), 3U);
  EXPECT_EQ(scene.instances[1].mesh, scene.instances[2].mesh);
  EXPECT_EQ(scene.instances[3].mesh, scene.instances[0].mesh);
  EXPECT_EQ(scene.instances[3].scale, 2.0);
  EXPECT_EQ(scene.instances[1].scale, 1.0);
  EXPECT_EQ(scale_of(scene, scene.instances[4]), Eigen::Vector3d(1.0, 2.0, 4.0));
  EXPECT_EQ(bounds(scene.meshes[scene.instances[1].mesh]).sizes(), Eigen::Vector3d(2.0, 4.0, 6.0));
  EXPECT_EQ(scene.sources[scene.instances[1].mesh].path, "builtin:box");
}

Scene scene_of(const char* name) {
  Scene scene;
  add_model(scene, make_builtin_model(name));
  return scene;
}

TEST(SetScale, RestoresTheLoadedMesh) {
  Scene scene = scene_of("box");
  set_scale(scene, 0, {0.1, 0.3, 0.7});
  set_scale(scene, 0, {0.7, 0.1, 0.3});
  set_scale(scene, 0, Eigen::Vector3d::Constant(3.0));
  EXPECT_EQ(scene.instances[0].scale, 3.0);
  EXPECT_EQ(bounds(scene.meshes[scene.instances[0].mesh]).sizes(), Eigen::Vector3d(2.0, 2.0, 2.0));
  EXPECT_EQ(scale_of(scene, scene.instances[0]), Eigen::Vector3d::Constant(3.0));
}

TEST(SetScale, RemovesScaledMeshesWithoutInstances) {
  Scene scene = scene_of("box");
  add_model(scene, make_builtin_model("sphere"));
  scene.instances.push_back(Instance(scene.instances[0]));
  for (int k = 0; k < 100; ++k) set_scale(scene, 0, {1.0, 2.0, 3.0 + k});
  EXPECT_EQ(scene.meshes.size(), 3U);
  set_scale(scene, 1, {2.0, 1.0, 1.0});
  set_scale(scene, 2, {1.0, 2.0, 102.0});
  EXPECT_EQ(scene.instances[0].mesh, scene.instances[2].mesh);
  set_scale(scene, 0, Eigen::Vector3d::Ones());
  EXPECT_EQ(scene.meshes.size(), 4U);  // the other one has it still
  set_scale(scene, 2, {1.0, 1.0, 2.0});
  ASSERT_EQ(scene.meshes.size(), 4U);
  ASSERT_EQ(scene.sources.size(), 4U);
  const auto size_m = [&](std::size_t i) {
    const Eigen::AlignedBox3d box = bounds(scene.meshes.at(scene.instances[i].mesh));
    return Eigen::Vector3d(box.max() - box.min());
  };
  EXPECT_EQ(size_m(0), Eigen::Vector3d(2.0, 2.0, 2.0));
  EXPECT_NEAR(size_m(1).x(), 2.0 * size_m(1).z(), 0.01);  // the sphere
  EXPECT_EQ(size_m(2), Eigen::Vector3d(2.0, 2.0, 4.0));
  for (std::size_t i = 0; i < 3; ++i) set_scale(scene, i, Eigen::Vector3d::Constant(3.0));
  EXPECT_EQ(scene.meshes.size(), 2U);
  EXPECT_NO_THROW(validate(scene));
}

TEST(SetScale, RejectsZeroAndExtremeFactors) {
  Scene scene = scene_of("box");
  for (const double bad :
       {0.0, -0.0, -1e300, -1e-300, std::nan(""), double{INFINITY}, 1e300, 1e-300}) {
    EXPECT_THROW(set_scale(scene, 0, {1.0, bad, 1.0}), Error) << bad;
    EXPECT_THROW(set_scale(scene, 0, Eigen::Vector3d::Constant(bad)), Error) << bad;
  }
  EXPECT_EQ(scene.instances[0].scale, 1.0);
  EXPECT_EQ(scene.meshes.size(), 1U);
}

/// One triangle with its normal along +z, whose texture runs along x and y.
Scene textured_triangle() {
  Model model;
  model.mesh.positions_m = {{1, 0, 2}, {3, 0, 2}, {1, 4, 2}};
  model.mesh.normals = {{0, 0, 1}, {0, 0.6F, 0.8F}, {0, 0, 1}};
  model.mesh.tangents = {{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, -1}};
  model.mesh.triangles = {{0, 1, 2}};
  model.materials = {Material{}};
  Scene scene;
  add_model(scene, std::move(model));
  return scene;
}

TEST(SetScale, NegativeFactorsMirrorTheMesh) {
  Scene scene = textured_triangle();
  set_scale(scene, 0, {-1.0, 1.0, 1.0});
  const Mesh& mesh = scene.meshes.at(scene.instances[0].mesh);
  EXPECT_EQ(scale_of(scene, scene.instances[0]), Eigen::Vector3d(-1.0, 1.0, 1.0));
  EXPECT_EQ(mesh.positions_m, (std::vector<Eigen::Vector3f>{{-1, 0, 2}, {-3, 0, 2}, {-1, 4, 2}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 2, 1}}));
  EXPECT_EQ(mesh.normals[1], Eigen::Vector3f(0, 0.6F, 0.8F));
  EXPECT_EQ(mesh.tangents[0], Eigen::Vector4f(-1, 0, 0, -1));
  EXPECT_EQ(mesh.tangents[2], Eigen::Vector4f(-1, 0, 0, 1));
}

TEST(SetScale, TwoNegativeFactorsTurnTheMesh) {
  Scene scene = textured_triangle();
  set_scale(scene, 0, {-1.0, -2.0, 1.0});
  const Mesh& mesh = scene.meshes.at(scene.instances[0].mesh);
  EXPECT_EQ(mesh.positions_m[2], Eigen::Vector3f(-1, -8, 2));
  EXPECT_FALSE(std::signbit(mesh.positions_m[0].y()));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(mesh.tangents[0], Eigen::Vector4f(-1, 0, 0, 1));
}

TEST(SetScale, ANegativeFactorMirrorsAtTheOrigin) {
  Scene scene = textured_triangle();
  set_scale(scene, 0, Eigen::Vector3d::Constant(-2.0));
  EXPECT_EQ(scene.instances[0].scale, 1.0);
  EXPECT_EQ(scale_of(scene, scene.instances[0]), Eigen::Vector3d::Constant(-2.0));
  const Mesh& mesh = scene.meshes.at(scene.instances[0].mesh);
  EXPECT_EQ(mesh.positions_m[1], Eigen::Vector3f(-6, 0, -4));
  EXPECT_EQ(mesh.normals[0], Eigen::Vector3f(0, 0, -1));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 2, 1}}));
  EXPECT_EQ(mesh.tangents[0], Eigen::Vector4f(-1, 0, 0, -1));
}

TEST(SetScale, NormalsAreThoseOfTheScaledSurface) {
  Scene scene = scene_of("sphere");
  const Eigen::Vector3d axes_m(2.0, 0.5, 1.25);
  set_scale(scene, 0, axes_m);
  const Mesh& mesh = scene.meshes[scene.instances[0].mesh];
  for (std::uint32_t v = 0; v < mesh.positions_m.size(); ++v) {
    // of the ellipsoid x^2/a^2 + y^2/b^2 + z^2/c^2 = 1: its gradient
    const Eigen::Vector3d gradient = vertex_m(mesh, v).cwiseQuotient(axes_m.cwiseProduct(axes_m));
    EXPECT_LT((mesh.normals[v].cast<double>() - gradient.normalized()).norm(), 1e-6) << v;
  }
}

}  // namespace
}  // namespace glidar
