// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/raster/packed_mesh.hpp>
#include <glidar/render/raster/tile_buffer.hpp>
#include <glidar/render/raster/triangle_setup.hpp>
#include <glidar/render/raster/visible_clusters.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/render/triangle_ids.hpp>

#include <cstdint>
#include <vector>

namespace glidar::raster {

/// What one cast hands to every canvas.
struct DrawContext {
  const CastRequest& request;
  const Resolver& resolver;
  const std::vector<PackedMesh>& meshes;
  const std::vector<PixelView>& views;  ///< per instance
  const TriangleIds& triangles;
  const std::vector<std::uint8_t>& has_mask;  ///< per instance
  Nearness nearness;
};

/// Asks the memory for a cluster.
void prefetch(const DrawContext& context, const VisibleCluster& cluster);

/// A pixel of the picture, or where a canvas has its first one there.
struct PixelPosition {
  std::int32_t col;
  std::int32_t row;
};

/// Draws one cluster onto a canvas whose first pixel is this of the picture.
void draw_cluster(const DrawContext& context, const VisibleCluster& cluster,
                  const PixelPosition& first, TileBuffer& buffer);

}  // namespace glidar::raster
