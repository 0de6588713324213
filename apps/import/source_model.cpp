// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/source_model.hpp>

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
