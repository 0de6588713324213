// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

/// Triangles of one mesh that are drawn together because they are of one kind.
struct DrawRange {
  std::uint32_t first;  ///< in drawing order
  std::uint32_t count;
  std::uint32_t kind;
};

/// A mesh ordered for drawing: neighbouring triangles follow each other and share vertices that are
/// close in memory, so that the vertex cache is used well.
struct DrawOrder {
  std::vector<std::uint32_t> drawn;     ///< triangle of the mesh at each position
  std::vector<std::uint32_t> vertices;  ///< vertex of the mesh at each position
  std::vector<Triangle> triangles;      ///< those of `drawn`, corners as indices into `vertices`
  std::vector<DrawRange> ranges;
};

/// Sorts by the kinds of the triangles (empty: all are of kind 0), and within a kind along a
/// space-filling curve. Triangles at the same position keep the mesh's order.
DrawOrder draw_order(const Mesh& mesh, const std::vector<std::uint32_t>& kinds);

/// A vertex attribute in the order of `vertices`; empty if the mesh lacks it.
template <class Value>
std::vector<Value> in_order(const DrawOrder& order, const std::vector<Value>& of_vertex) {
  std::vector<Value> ordered;
  if (of_vertex.empty()) return ordered;
  ordered.reserve(order.vertices.size());
  for (const std::uint32_t vertex : order.vertices) ordered.push_back(of_vertex[vertex]);
  return ordered;
}

}  // namespace glidar
