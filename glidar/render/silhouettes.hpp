// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/renderer.hpp>
#include <glidar/render/resolver.hpp>
#include <glidar/render/triangle_ids.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

/// An edge of a mesh with its two triangles.
struct MeshEdge {
  static constexpr std::uint32_t kNone = 0xffffffffU;

  std::uint32_t from;    ///< vertex
  std::uint32_t to;      ///< vertex
  std::uint32_t first;   ///< triangle
  std::uint32_t second;  ///< triangle; kNone: there is no other, or more than one
};

/// The edges of a mesh, each once. Vertices at one position count as one; two corners at one
/// position have no edge between them.
std::vector<MeshEdge> mesh_edges(const Mesh& mesh);

/// The pixels whose beams pass close to a silhouette: an edge with a triangle on one side only, or
/// between a triangle that faces the sensor and one that does not. At other edges, a rasterizer
/// that moves the edge selects at worst an adjacent triangle.
class SilhouettePixels {
 public:
  /// Finds beams within `band_px` of a silhouette, pixels.
  explicit SilhouettePixels(double band_px) : band_px_(band_px) {}

  [[nodiscard]] double band_px() const { return band_px_; }

  /// Finds those in a rectangle of the image, as row * columns of the whole image + column, in
  /// rising order. `edges` has the edges of each mesh; the resolver has the cast's poses.
  const std::vector<std::size_t>& find(const CastRequest& request, const Resolver& resolver,
                                       const std::vector<std::vector<MeshEdge>>& edges,
                                       const PixelRect& part, ThreadPool& thread_pool);

 private:
  void find_sides(const Resolver& resolver, std::uint32_t instance, ThreadPool& thread_pool);
  void add(const CastRequest& request, const Resolver& resolver, std::uint32_t instance,
           const std::vector<MeshEdge>& edges, const PixelRect& part, ThreadPool& thread_pool);

  double band_px_;
  std::vector<std::int8_t> sides_;  ///< per triangle of an instance: where the sensor is
  std::vector<std::vector<std::size_t>>
      section_pixels_;  ///< pixels found in each piece of the edges
  std::vector<std::size_t> pixels_;
};

}  // namespace glidar
