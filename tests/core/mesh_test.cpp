// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/core/mesh.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace glidar {
namespace {

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

}  // namespace
}  // namespace glidar
