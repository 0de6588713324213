// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

/// Triangles of one mesh that are drawn together, because they are of one kind.
struct DrawRange {
  std::uint32_t first;  ///< in the order in which they are drawn
  std::uint32_t count;
  std::uint32_t kind;
};

/// A mesh laid out for drawing: triangles that lie near each other follow each other and share
/// corners that lie near each other in memory, so that a corner is worked out once and not for
/// every triangle at it. Files hold them in any order.
struct DrawOrder {
  std::vector<std::uint32_t> drawn;     ///< which triangle of the mesh comes at each place
  std::vector<std::uint32_t> vertices;  ///< which vertex of the mesh stands at each place
  std::vector<Triangle> triangles;      ///< those of `drawn`, corners as places in `vertices`
  std::vector<DrawRange> ranges;
};

/// By the kinds of the triangles (none given: all are of kind 0), in each along a curve through
/// space. Triangles in the same place keep the mesh's order.
DrawOrder draw_order(const Mesh& mesh, const std::vector<std::uint32_t>& kinds);

/// What stands at each vertex, in the order of `vertices`; nothing if there is nothing.
template <class Value>
std::vector<Value> in_order(const DrawOrder& order, const std::vector<Value>& of_vertex) {
  std::vector<Value> ordered;
  if (of_vertex.empty()) return ordered;
  ordered.reserve(order.vertices.size());
  for (const std::uint32_t vertex : order.vertices) ordered.push_back(of_vertex[vertex]);
  return ordered;
}

}  // namespace glidar
