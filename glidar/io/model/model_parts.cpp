// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/model_parts.hpp>

#include <algorithm>
#include <cstddef>
#include <set>
#include <unordered_map>
#include <unordered_set>

namespace glidar {
namespace {

/// Adds the triangles of a range to the part of its node.
void add_triangles(const Model& model, const ModelPart& range, PartSummary& part,
                   std::set<std::uint16_t>& materials) {
  part.triangles += range.triangle_count;
  for (std::uint32_t k = 0; k < range.triangle_count; ++k) {
    const std::uint32_t t = range.first_triangle + k;
    materials.insert(material_slot(model.mesh, t));
    for (const std::uint32_t v : model.mesh.triangles[t]) {
      part.box_m.extend(vertex_m(model.mesh, v));
    }
  }
}

}  // namespace

std::vector<std::string> part_names(const std::vector<ModelNode>& nodes) {
  std::vector<std::string> names(nodes.size());
  std::unordered_set<std::string> taken;
  std::unordered_map<std::string, std::uint64_t> counted;  // by path: how often the file has it
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const std::string& parent = names[nodes[i].parent];
    const std::string path = parent.empty() ? nodes[i].name : parent + "/" + nodes[i].name;
    std::uint64_t& n = counted[path];
    do {
      names[i] = ++n == 1 ? path : path + "_" + std::to_string(n);
    } while (!taken.insert(names[i]).second);
  }
  return names;
}

std::vector<PartSummary> list_parts(const Model& model) {
  const std::vector<ModelNode>& nodes = model.nodes;
  const std::vector<std::string> names = part_names(nodes);
  std::vector<PartSummary> parts(nodes.size());
  std::vector<std::set<std::uint16_t>> materials(nodes.size());
  for (const ModelPart& range : model.parts) {
    add_triangles(model, range, parts[range.node], materials[range.node]);
  }
  for (std::size_t i = nodes.size(); i-- > 1;) {
    const std::uint32_t parent = nodes[i].parent;
    parts[i].name = names[i];
    parts[i].parent = names[parent];
    parts[i].parent_from_part = nodes[parent].model_from_node.inverse() * nodes[i].model_from_node;
    parts[parent].triangles += parts[i].triangles;
    if (!parts[i].box_m.isEmpty()) parts[parent].box_m.extend(parts[i].box_m);
    for (const std::uint16_t m : materials[i])
      parts[i].materials.push_back(model.materials[m].name);
    materials[parent].insert(materials[i].begin(), materials[i].end());
  }
  parts.erase(parts.begin());
  return parts;
}

bool matches_pattern(std::string_view pattern, std::string_view text) {
  std::size_t p = 0;
  std::size_t t = 0;
  std::size_t star = std::string_view::npos;  // the last one, to which a mismatch returns
  std::size_t after_star = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      after_star = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++after_star;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

}  // namespace glidar
