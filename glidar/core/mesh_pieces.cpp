// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/mesh_pieces.hpp>

#include <algorithm>
#include <cstddef>

namespace glidar {
namespace {

struct Run {
  std::size_t first_vertex;
  std::size_t end_vertex;
  std::size_t first_triangle;
  std::size_t end_triangle;
};

Run range_of(const Mesh& mesh, std::size_t i) {
  const bool is_last = i + 1 == mesh.origins.size();
  return {.first_vertex = mesh.origins[i].first_vertex,
          .end_vertex = is_last ? mesh.positions_m.size() : mesh.origins[i + 1].first_vertex,
          .first_triangle = mesh.origins[i].first_triangle,
          .end_triangle = is_last ? mesh.triangles.size() : mesh.origins[i + 1].first_triangle};
}

template <class T>
void append(const std::vector<T>& from, std::size_t first, std::size_t end, std::vector<T>& to) {
  if (from.empty()) return;
  to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(first),
            from.begin() + static_cast<std::ptrdiff_t>(end));
}

void append(const Mesh& whole, const Run& run, MeshPiece& piece) {
  Mesh& mesh = piece.mesh;
  const std::size_t before = mesh.positions_m.size();
  append(whole.positions_m, run.first_vertex, run.end_vertex, mesh.positions_m);
  append(whole.normals, run.first_vertex, run.end_vertex, mesh.normals);
  append(whole.uvs[0], run.first_vertex, run.end_vertex, mesh.uvs[0]);
  append(whole.uvs[1], run.first_vertex, run.end_vertex, mesh.uvs[1]);
  append(whole.tangents, run.first_vertex, run.end_vertex, mesh.tangents);
  append(whole.colours, run.first_vertex, run.end_vertex, mesh.colours);
  append(whole.material_slots, run.first_triangle, run.end_triangle, mesh.material_slots);
  const auto renumbered = [&](std::uint32_t vertex) {
    return static_cast<std::uint32_t>(vertex - run.first_vertex + before);
  };
  for (std::size_t t = run.first_triangle; t < run.end_triangle; ++t) {
    const Triangle& corners = whole.triangles[t];
    mesh.triangles.push_back(
        {renumbered(corners[0]), renumbered(corners[1]), renumbered(corners[2])});
    piece.triangles.push_back(static_cast<std::uint32_t>(t));
  }
}

}  // namespace

std::vector<MeshPiece> cut_at_origins(const Mesh& mesh) {
  std::vector<MeshPiece> pieces;
  for (std::size_t i = 0; i < mesh.origins.size(); ++i) {
    const Eigen::Vector3d& origin_m = mesh.origins[i].origin_m;
    auto piece = std::find_if(pieces.begin(), pieces.end(), [&](const MeshPiece& other) {
      return other.mesh.origin_m == origin_m;
    });
    if (piece == pieces.end()) {
      piece = pieces.insert(pieces.end(), MeshPiece{});
      piece->mesh.name = mesh.name;
      piece->mesh.origin_m = origin_m;
    }
    append(mesh, range_of(mesh, i), *piece);
  }
  return pieces;
}

}  // namespace glidar
