// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/vertex_attributes.hpp>

#include <glidar/io/model/builtin_models.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glidar {
namespace {

constexpr double kQuarter = std::numbers::pi / 4.0;

Eigen::Vector3f face_normal(const Mesh& mesh, const Triangle& t) {
  const auto& p = mesh.positions_m;
  return (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).normalized();
}

/// Eight corners, twelve triangles, fronts outside.
Mesh cube() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions_m.emplace_back(i & 1 ? 1.0F : -1.0F, i & 2 ? 1.0F : -1.0F, i & 4 ? 1.0F : -1.0F);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

Mesh sphere() {
  Mesh mesh = make_builtin_model("sphere").mesh;
  mesh.normals.clear();
  return mesh;
}

/// Two unit squares that meet in the y axis, the second turned down by an angle.
Mesh fold(double angle_rad) {
  const auto c = static_cast<float>(std::cos(angle_rad));
  const auto s = static_cast<float>(std::sin(angle_rad));
  Mesh mesh;
  mesh.positions_m = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {c, 0, -s}, {c, 1, -s}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  return mesh;
}

TEST(CreaseNormals, ACubeIsFlat) {
  Mesh mesh = cube();
  make_normals(mesh, kQuarter);
  EXPECT_EQ(mesh.positions_m.size(), 24U);
  ASSERT_EQ(mesh.normals.size(), 24U);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      EXPECT_LT((mesh.normals[v] - face_normal(mesh, t)).norm(), 1e-6F);
    }
  }
}

TEST(CreaseNormals, AWideCreaseRoundsTheCube) {
  Mesh mesh = cube();
  make_normals(mesh, std::numbers::pi / 2.0 + 0.01);
  EXPECT_EQ(mesh.positions_m.size(), 8U);
  // Three faces meet with a right angle each, so the weighted normal is the diagonal.
  for (std::size_t v = 0; v < 8; ++v) {
    EXPECT_LT((mesh.normals[v] - mesh.positions_m[v].normalized()).norm(), 1e-6F);
  }
}

TEST(CreaseNormals, ASphereIsSmooth) {
  Mesh mesh = sphere();
  const std::size_t vertices = mesh.positions_m.size();
  make_normals(mesh, kQuarter);
  EXPECT_EQ(mesh.positions_m.size(), vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    EXPECT_GT(mesh.normals[v].dot(mesh.positions_m[v].normalized()), 0.9998F);
  }
}

TEST(CreaseNormals, TheCreaseAngleSeparatesNormals) {
  Mesh below = fold(0.7);
  make_normals(below, 0.75);
  EXPECT_EQ(below.positions_m.size(), 6U);
  Mesh above = fold(0.8);
  make_normals(above, 0.75);
  EXPECT_EQ(above.positions_m.size(), 8U);  // the two vertices of the crease are split
  EXPECT_LT((above.normals[above.triangles[0][1]] - Eigen::Vector3f::UnitZ()).norm(), 1e-6F);
}

TEST(CreaseNormals, TrianglesKeepTheirOrderAndPlaces) {
  const Mesh before = cube();
  Mesh after = cube();
  make_normals(after, kQuarter);
  ASSERT_EQ(after.triangles.size(), before.triangles.size());
  for (std::size_t t = 0; t < after.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(after.positions_m[after.triangles[t][k]],
                before.positions_m[before.triangles[t][k]]);
    }
  }
}

TEST(CreaseNormals, SeamsOfUvsDoNotAffectNormals) {
  Mesh mesh = fold(0.3);
  mesh.positions_m.push_back(mesh.positions_m[1]);  // the right square has vertices of its own
  mesh.positions_m.push_back(mesh.positions_m[2]);
  mesh.triangles[2] = {6, 4, 5};
  mesh.triangles[3] = {6, 5, 7};
  mesh.uvs[0].assign(8, Eigen::Vector2f::Zero());
  make_normals(mesh, kQuarter);
  EXPECT_EQ(mesh.normals[1], mesh.normals[6]);
  EXPECT_EQ(mesh.normals[2], mesh.normals[7]);
}

TEST(CreaseNormals, DegenerateAndTinyTrianglesGiveFiniteUnitNormals) {
  Mesh mesh = fold(0.3);
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({1, 1, 1});
  for (Eigen::Vector3f& p : mesh.positions_m) p *= 1e-30F;
  make_normals(mesh, kQuarter);
  for (const Eigen::Vector3f& n : mesh.normals) EXPECT_NEAR(n.norm(), 1.0F, 1e-5F);
  EXPECT_GT(mesh.normals[0].z(), 0.99F);
}

TEST(CreaseNormals, AVertexWithVeryManyFacesIsProcessedInTime) {
  constexpr std::uint32_t kFaces = 200'000;
  Mesh mesh;
  mesh.positions_m.emplace_back(0.0F, 0.0F, 0.0F);
  for (std::uint32_t i = 0; i <= kFaces; ++i) {
    const double a = 2.0 * std::numbers::pi * i / kFaces;
    mesh.positions_m.emplace_back(std::cos(a), std::sin(a), i % 2 == 0 ? 5.0 : -5.0);
    if (i > 0) mesh.triangles.push_back({0, i, i + 1});
  }
  make_normals(mesh, kQuarter);
  EXPECT_EQ(mesh.normals.size(), mesh.positions_m.size());
}

TEST(VertexWeld, MergesIdenticalVerticesAndRemovesUnusedOnes) {
  Mesh mesh;
  mesh.positions_m = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  mesh.triangles = {{1, 2, 3}, {4, 6, 5}};
  weld_vertices(mesh);
  EXPECT_EQ(mesh.positions_m.size(), 4U);
  EXPECT_EQ(mesh.triangles[0], (Triangle{0, 1, 2}));
  EXPECT_EQ(mesh.triangles[1], (Triangle{1, 3, 2}));
}

TEST(VertexWeld, KeepsTheSmallestDifference) {
  Mesh mesh;
  mesh.positions_m = {{0, 0, 0}, {1e-42F, 0, 0}, {0, 1e-42F, 0}};
  mesh.triangles = {{0, 1, 2}};
  weld_vertices(mesh);
  EXPECT_EQ(mesh.positions_m.size(), 3U);
}

TEST(VertexWeld, KeepsSeams) {
  Mesh mesh;
  mesh.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  mesh.uvs[0] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  mesh.triangles = {{0, 1, 2}, {3, 2, 1}};
  weld_vertices(mesh);
  EXPECT_EQ(mesh.positions_m.size(), 4U);
}

Mesh mapped_square() {
  Mesh mesh;
  mesh.positions_m = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  mesh.normals.assign(4, Eigen::Vector3f::UnitZ());
  mesh.uvs[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TEST(Tangents, RunAlongU) {
  Mesh mesh = mapped_square();
  make_tangents(mesh, 0);
  for (const Eigen::Vector4f& t : mesh.tangents) EXPECT_EQ(t, Eigen::Vector4f(1, 0, 0, 1));
}

TEST(Tangents, MirroredUvsFlipTheBitangent) {
  Mesh mesh = mapped_square();
  for (Eigen::Vector2f& uv : mesh.uvs[0]) uv.x() = -uv.x();
  make_tangents(mesh, 0);
  for (const Eigen::Vector4f& t : mesh.tangents) EXPECT_EQ(t, Eigen::Vector4f(-1, 0, 0, -1));
}

TEST(Tangents, ASeamBetweenMirroredHalvesIsSplit) {
  Mesh mesh = mapped_square();
  mesh.uvs[0][3] = {1, 0};  // mirrors the second triangle's uvs
  make_tangents(mesh, 0);
  EXPECT_EQ(mesh.positions_m.size(), 6U);
  EXPECT_EQ(mesh.tangents.size(), 6U);
  EXPECT_EQ(mesh.tangents[mesh.triangles[0][0]].w(), 1.0F);
  EXPECT_EQ(mesh.tangents[mesh.triangles[1][0]].w(), -1.0F);
}

TEST(Tangents, AreUnitAndPerpendicularToTheNormalWithoutUvArea) {
  Mesh mesh = mapped_square();
  mesh.uvs[0].assign(4, {0.5F, 0.5F});
  make_tangents(mesh, 0);
  for (const Eigen::Vector4f& t : mesh.tangents) {
    EXPECT_NEAR(t.head<3>().norm(), 1.0F, 1e-6F);
    EXPECT_NEAR(t.z(), 0.0F, 1e-6F);
  }
}

}  // namespace
}  // namespace glidar
