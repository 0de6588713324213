// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/source_model.hpp>

#include <glidar/core/excerpt.hpp>
#include <glidar/io/model/mesh_blob.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace glidar::import {

Refusal no_triangles(const std::string& instead) {
  return {
      "no triangles" + instead,
      "GLIDAR needs surfaces: name a model with triangles or polygons (of a point cloud, make a "
      "mesh first)"};
}

Material SourceMaterial::white_material() {
  Material white;
  white.diffuse = white.ambient = Eigen::Vector3f::Ones();
  return white;
}

std::uint32_t add_node(std::vector<SourceNode>& nodes, const std::string& name,
                       std::uint32_t parent, const Eigen::Matrix4d& model_from_node) {
  // The path of a part has the names of all nodes above it.
  constexpr std::uint32_t kMaxDepth = 64;
  constexpr std::size_t kMaxName_bytes = 100;
  const std::uint32_t depth = nodes.at(parent).depth + 1;
  if (name.empty() || depth > kMaxDepth || nodes.size() >= kMaxRecords) return parent;
  nodes.push_back({excerpt(name, kMaxName_bytes), parent, depth, model_from_node});
  return static_cast<std::uint32_t>(nodes.size() - 1);
}

void check_size(const SourceModel& source) {
  std::uint64_t triangles = 0;
  for (const Placed& placed : source.placed) {
    triangles += source.meshes.at(placed.mesh).triangles.size();
    if (triangles > kMaxTriangles) break;
  }
  if (triangles > kMaxTriangles || source.placed.size() > kMaxRecords) {
    throw Refusal{fmt::format("the instances in its tree have more than {} "
                              "triangles or {} parts",
                              kMaxTriangles, kMaxRecords),
                  "make the model smaller, or place its parts by a scene file"};
  }
  if (triangles > 0) return;
  throw no_triangles(source.lines_and_points > 0
                         ? fmt::format(", only {} points and lines", source.lines_and_points)
                         : "");
}

void add_note(SourceModel& source, const std::string& note) {
  if (std::find(source.notes.begin(), source.notes.end(), note) == source.notes.end()) {
    source.notes.push_back(note);
  }
}

}  // namespace glidar::import
