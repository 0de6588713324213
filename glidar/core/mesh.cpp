// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/mesh.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>

namespace glidar {
namespace {

template <class T>
void require_size(const Mesh& mesh, const std::vector<T>& values, std::size_t size,
                  const char* field) {
  if (values.empty() || values.size() == size) return;
  throw Error({.where = "mesh '" + mesh.name + "', " + field,
               .found = std::to_string(values.size()) + " entries",
               .allowed = "0 or " + std::to_string(size),
               .remedy = ""});
}

}  // namespace

Eigen::AlignedBox3d bounds(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : mesh.positions_m) {
    if (p.allFinite()) box.extend(p);
  }
  if (box.isEmpty()) return {};
  return {mesh.origin_m + box.min().cast<double>(), mesh.origin_m + box.max().cast<double>()};
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
                   .allowed = "below " + std::to_string(vertices),
                   .remedy = ""});
    }
  }
  for (const Eigen::Vector3f& position : mesh.positions_m) {
    if (position.allFinite()) continue;
    throw Error({.where = "mesh '" + mesh.name + "', positions_m",
                 .found = "a coordinate is not finite",
                 .allowed = "finite metres",
                 .remedy = ""});
  }
}

}  // namespace glidar
