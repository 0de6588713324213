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

/// Inputs that all tiles of a cast share.
struct DrawContext {
  const CastRequest& request;
  const Resolver& resolver;
  const std::vector<PackedMesh>& meshes;
  const std::vector<PixelView>& views;  ///< per instance
  const TriangleIds& triangles;
  const std::vector<std::uint8_t>& has_mask;  ///< per instance
  Nearness nearness;
};

/// Prefetches a cluster.
void prefetch(const DrawContext& context, const VisibleCluster& cluster);

/// A pixel of the image, or the position of a tile's first pixel in the image.
struct PixelPosition {
  std::int32_t col;
  std::int32_t row;
};

/// Draws one cluster into a tile that starts at the pixel `first` of the image.
void draw_cluster(const DrawContext& context, const VisibleCluster& cluster,
                  const PixelPosition& first, TileBuffer& buffer);

}  // namespace glidar::raster
