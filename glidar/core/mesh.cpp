// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/mesh.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace glidar {
namespace {

template <class T>
void require_size(const Mesh& mesh, const std::vector<T>& values, std::size_t size,
                  const char* field) {
  if (values.empty() || values.size() == size) return;
  throw Error({.where = "mesh '" + mesh.name + "', " + field,
               .found = std::to_string(values.size()) + " entries",
               .allowed = "0 or " + std::to_string(size)});
}

/// The bounding box of the vertices [first, end), which share an origin.
Eigen::AlignedBox3d box_of_range(const Mesh& mesh, const Eigen::Vector3d& origin_m,
                                 std::size_t first, std::size_t end) {
  Eigen::AlignedBox3f box;
  for (std::size_t v = first; v < end; ++v) {
    if (mesh.positions_m[v].allFinite()) box.extend(mesh.positions_m[v]);
  }
  if (box.isEmpty()) return {};
  return {origin_m + box.min().cast<double>(), origin_m + box.max().cast<double>()};
}

[[noreturn]] void reject_origins(const Mesh& mesh, std::string found) {
  throw Error({.where = "mesh '" + mesh.name + "', origins",
               .found = std::move(found),
               .allowed =
                   "origins in increasing order, the first from 0, each with triangles of its "
                   "own vertices"});
}

void validate_origin(const Mesh& mesh, std::size_t index) {
  const MeshOrigin& origin = mesh.origins[index];
  const bool is_last = index + 1 == mesh.origins.size();
  const std::size_t end_vertex =
      is_last ? mesh.positions_m.size() : mesh.origins[index + 1].first_vertex;
  const std::size_t end_triangle =
      is_last ? mesh.triangles.size() : mesh.origins[index + 1].first_triangle;
  if (origin.first_vertex > end_vertex || origin.first_triangle > end_triangle ||
      end_vertex > mesh.positions_m.size() || end_triangle > mesh.triangles.size()) {
    reject_origins(mesh,
                   "origin " + std::to_string(index) + " ends before it begins or beyond the mesh");
  }
  if (!origin.origin_m.allFinite()) reject_origins(mesh, "an origin that is not finite");
  for (std::size_t t = origin.first_triangle; t < end_triangle; ++t) {
    for (const std::uint32_t corner : mesh.triangles[t]) {
      if (corner >= origin.first_vertex && corner < end_vertex) continue;
      reject_origins(mesh, "triangle " + std::to_string(t) + " uses a vertex of another origin");
    }
  }
}

void validate_origins(const Mesh& mesh) {
  if (mesh.origins.empty()) return;
  if (mesh.origins[0].first_vertex != 0 || mesh.origins[0].first_triangle != 0) {
    reject_origins(mesh, "the first origin does not begin at 0");
  }
  for (std::size_t i = 0; i < mesh.origins.size(); ++i) validate_origin(mesh, i);
}

}  // namespace

const Eigen::Vector3d& origin_of(const Mesh& mesh, std::uint32_t vertex) {
  if (mesh.origins.empty()) return mesh.origin_m;
  const auto is_before = [](std::uint32_t v, const MeshOrigin& run) {
    return v < run.first_vertex;
  };
  // The first range begins at 0, so there is always one before.
  return std::prev(std::upper_bound(mesh.origins.begin(), mesh.origins.end(), vertex, is_before))
      ->origin_m;
}

Eigen::AlignedBox3d bounds(const Mesh& mesh) {
  const std::size_t vertices = mesh.positions_m.size();
  if (mesh.origins.empty()) return box_of_range(mesh, mesh.origin_m, 0, vertices);
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < mesh.origins.size(); ++i) {
    const std::size_t end =
        i + 1 < mesh.origins.size() ? mesh.origins[i + 1].first_vertex : vertices;
    const Eigen::AlignedBox3d of_run =
        box_of_range(mesh, mesh.origins[i].origin_m, mesh.origins[i].first_vertex, end);
    if (!of_run.isEmpty()) box.extend(of_run);
  }
  return box;
}

std::uint32_t slot_count(const Mesh& mesh) {
  if (mesh.material_slots.empty()) return 1;
  return *std::max_element(mesh.material_slots.begin(), mesh.material_slots.end()) + 1U;
}

void validate(const Mesh& mesh) {
  const std::size_t vertices = mesh.positions_m.size();
  require_size(mesh, mesh.normals, vertices, "normals");
  require_size(mesh, mesh.uvs[0], vertices, "uvs[0]");
  require_size(mesh, mesh.uvs[1], vertices, "uvs[1]");
  require_size(mesh, mesh.tangents, vertices, "tangents");
  require_size(mesh, mesh.colours, vertices, "colours");
  require_size(mesh, mesh.material_slots, mesh.triangles.size(), "material_slots");
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (corner < vertices) continue;
      throw Error({.where = "mesh '" + mesh.name + "', triangles",
                   .found = "a corner is vertex " + std::to_string(corner),
                   .allowed = "below " + std::to_string(vertices)});
    }
  }
  validate_origins(mesh);
  for (const Eigen::Vector3f& position : mesh.positions_m) {
    if (position.allFinite()) continue;
    throw Error({.where = "mesh '" + mesh.name + "', positions_m",
                 .found = "a coordinate is not finite",
                 .allowed = "finite metres"});
  }
}

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
