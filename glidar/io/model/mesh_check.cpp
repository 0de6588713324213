// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/mesh_check.hpp>

#include <glidar/core/mesh.hpp>
#include <glidar/io/model/vertex_attributes.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace glidar {
namespace {

/// One side of a triangle, as an undirected edge.
struct Side {
  std::uint32_t low;
  std::uint32_t high;
  bool upwards;  ///< directed from low to high

  bool operator<(const Side& other) const {
    return std::tie(low, high) < std::tie(other.low, other.high);
  }
  [[nodiscard]] bool same_edge(const Side& other) const {
    return low == other.low && high == other.high;
  }
};

/// Sorted values. `first_of` is the number, below `vertices`, by which they are sorted first:
/// values are placed by it, and only the few with the same one are compared.
template <class T, class FirstOf>
std::vector<T> sorted(const std::vector<T>& values, std::size_t vertices, FirstOf first_of) {
  std::vector<std::size_t> ends(vertices + 1, 0);
  for (const T& value : values) ++ends[first_of(value) + 1];
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<T> placed(values.size());
  for (const T& value : values) placed[ends[first_of(value)]++] = value;
  auto begin = placed.begin();
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto end = placed.begin() + static_cast<std::ptrdiff_t>(ends[v]);
    std::sort(begin, end);
    begin = end;
  }
  return placed;
}

/// Triangles with vertices replaced by the first vertex at the same position.
std::vector<Triangle> by_place(const Mesh& mesh, const std::vector<std::uint32_t>& place) {
  std::vector<Triangle> triangles = mesh.triangles;
  for (Triangle& t : triangles) {
    for (std::uint32_t& corner : t) corner = place[corner];
  }
  return triangles;
}

std::vector<Side> sides_of(const std::vector<Triangle>& triangles, std::size_t vertices) {
  std::vector<Side> sides;
  sides.reserve(triangles.size() * 3);
  for (const Triangle& t : triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k];
      const std::uint32_t to = t[(k + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), from < to});
    }
  }
  return sorted(sides, vertices, [](const Side& side) { return side.low; });
}

void count_edges(const std::vector<Triangle>& triangles, std::size_t vertices, MeshCheck& check) {
  const std::vector<Side> sides = sides_of(triangles, vertices);
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t end = first;
    std::size_t upwards = 0;
    for (; end < sides.size() && sides[end].same_edge(sides[first]); ++end) {
      upwards += sides[end].upwards ? 1 : 0;
    }
    const std::size_t count = end - first;
    check.open_edges += count == 1 ? 1 : 0;
    check.crowded_edges += count > 2 ? 1 : 0;
    check.inconsistent_edges += count == 2 && upwards != 1 ? 1 : 0;
    first = end;
  }
}

void count_duplicates(std::vector<Triangle> triangles, std::size_t vertices, MeshCheck& check) {
  for (Triangle& t : triangles) std::sort(t.begin(), t.end());
  triangles = sorted(triangles, vertices, [](const Triangle& t) { return t[0]; });
  for (std::size_t i = 1; i < triangles.size(); ++i) {
    check.duplicate_triangles += triangles[i] == triangles[i - 1] ? 1 : 0;
  }
}

void measure(const Mesh& mesh, MeshCheck& check) {
  // Relative to the centre of the box: far from zero, cancellation would make the sum of signed
  // volumes imprecise.
  const Eigen::Vector3d middle = bounds(mesh).center() - mesh.origin_m;
  constexpr double kFlat = 1e-12;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.positions_m[t[0]].cast<double>() - middle;
    const Eigen::Vector3d b = mesh.positions_m[t[1]].cast<double>() - middle;
    const Eigen::Vector3d c = mesh.positions_m[t[2]].cast<double>() - middle;
    const double area = (b - a).cross(c - a).norm() / 2.0;
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    check.degenerate_triangles += area <= kFlat * longest ? 1 : 0;
    check.area_m2 += area;
    check.signed_volume_m3 += a.dot(b.cross(c)) / 6.0;
  }
}

void count_vertices(const Mesh& mesh, const std::vector<std::uint32_t>& place, MeshCheck& check) {
  std::vector<bool> used(place.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t corner : t) used[corner] = true;
  }
  for (std::uint32_t v = 0; v < place.size(); ++v) {
    check.duplicate_vertices += place[v] != v ? 1 : 0;
    check.unused_vertices += used[v] ? 0 : 1;
  }
}

void add(const MeshCheck& part, MeshCheck& all) {
  all.open_edges += part.open_edges;
  all.crowded_edges += part.crowded_edges;
  all.inconsistent_edges += part.inconsistent_edges;
  all.degenerate_triangles += part.degenerate_triangles;
  all.duplicate_triangles += part.duplicate_triangles;
  all.duplicate_vertices += part.duplicate_vertices;
  all.unused_vertices += part.unused_vertices;
  all.area_m2 += part.area_m2;
  all.signed_volume_m3 += part.signed_volume_m3;
}

}  // namespace

MeshCheck check_mesh(const Mesh& mesh) {
  MeshCheck check;
  // Pieces share no positions, so their results can be added.
  for (const MeshPiece& piece : cut_at_origins(mesh)) add(check_mesh(piece.mesh), check);
  if (!mesh.origins.empty()) return check;
  if (mesh.triangles.empty()) return check;
  const std::vector<std::uint32_t> place = first_at_position(mesh.positions_m);
  std::vector<Triangle> triangles = by_place(mesh, place);
  count_edges(triangles, place.size(), check);
  count_duplicates(std::move(triangles), place.size(), check);
  measure(mesh, check);
  count_vertices(mesh, place, check);
  return check;
}

}  // namespace glidar
