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

/// The elements of a list, which may be empty, in this order.
template <class T>
std::vector<T> chosen(const std::vector<T>& from, std::span<const std::uint32_t> indices) {
  std::vector<T> to;
  if (from.empty()) return to;
  to.reserve(indices.size());
  for (const std::uint32_t i : indices) to.push_back(from[i]);
  return to;
}

/// How many of the ascending numbers are below a limit.
std::uint32_t count_below(std::span<const std::uint32_t> numbers, std::size_t limit) {
  return static_cast<std::uint32_t>(std::lower_bound(numbers.begin(), numbers.end(), limit) -
                                    numbers.begin());
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

Mesh extract_triangles(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
  std::vector<std::uint32_t> vertices;
  for (const std::uint32_t t : triangles) {
    vertices.insert(vertices.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  Mesh part;
  part.name = mesh.name;
  part.origin_m = mesh.origin_m;
  part.positions_m = chosen(mesh.positions_m, vertices);
  part.normals = chosen(mesh.normals, vertices);
  part.uvs = {chosen(mesh.uvs[0], vertices), chosen(mesh.uvs[1], vertices)};
  part.tangents = chosen(mesh.tangents, vertices);
  part.colours = chosen(mesh.colours, vertices);
  part.material_slots = chosen(mesh.material_slots, triangles);
  part.triangles = chosen(mesh.triangles, triangles);
  for (Triangle& corners : part.triangles) {
    for (std::uint32_t& vertex : corners) vertex = count_below(vertices, vertex);
  }
  for (std::size_t i = 0; i < mesh.origins.size(); ++i) {
    const Run run = range_of(mesh, i);
    const std::uint32_t first = count_below(triangles, run.first_triangle);
    if (first == count_below(triangles, run.end_triangle)) continue;
    part.origins.push_back(
        {count_below(vertices, run.first_vertex), first, mesh.origins[i].origin_m});
  }
  if (part.origins.size() == 1) {
    part.origin_m = part.origins.front().origin_m;
    part.origins.clear();
  }
  return part;
}

}  // namespace glidar
