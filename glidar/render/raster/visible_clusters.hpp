// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/render/depth_range.hpp>
#include <glidar/render/grid_window.hpp>
#include <glidar/render/raster/packed_mesh.hpp>
#include <glidar/render/raster/tile_buffer.hpp>
#include <glidar/render/resolver.hpp>

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace glidar::raster {

/// An instance as a pinhole sees it.
struct PixelView {
  /// From a point relative to the mesh's origin to (column, row, 1) times its depth, m.
  Eigen::Matrix<double, 3, 4> pixel_from_object;
};

PixelView pixel_view(const InstanceView& view, const PinholeIntrinsics& pinhole);

/// What a depth is called where nearness is compared: near (far - z) / (z (far - near)), 1 at the
/// near plane and 0 at the far one; what is nearer still has more. It is linear in the picture.
struct Nearness {
  explicit Nearness(const DepthRange& depths)
      : far_m(depths.far_m), factor(depths.near_m / (depths.far_m - depths.near_m)) {}
  double far_m;
  double factor;

  [[nodiscard]] double at(double depth_m) const { return factor * (far_m - depth_m) / depth_m; }
};

/// Where kLanes clusters may be seen: columns and rows, both ends included, and how near they may
/// come. An empty range of columns: nowhere.
struct ClusterBounds {
  Lanes<std::int32_t> left;
  Lanes<std::int32_t> right;
  Lanes<std::int32_t> top;
  Lanes<std::int32_t> bottom;
  Lanes<float> nearness;
};

/// Of boxes around clusters, in the part of a picture that is of interest.
void bound_clusters(const PixelView& view, const Nearness& nearness, const GridWindow& window,
                    const BoxPacket& boxes, ClusterBounds& bounds);

/// Some clusters of an instance.
struct ClusterRange {
  std::uint32_t instance;
  std::uint32_t first;
  std::uint32_t end;
};

/// A cluster that may be seen, and where: columns and rows of the picture, both ends included.
struct VisibleCluster {
  std::uint32_t instance;
  std::uint32_t cluster;
  std::int32_t left;
  std::int32_t right;
  std::int32_t top;
  std::int32_t bottom;
  float nearness;  ///< at most; infinite where the cluster reaches to the sensor's plane
};

/// True when nothing of a cluster's box, which may reach behind the sensor, is seen in the
/// rectangle of pixels, both ends included.
bool is_outside(const PixelView& view, const BoxPacket& boxes, unsigned lane,
                const PixelBounds& pixels);

/// Adds those of the range that may be seen; its first is a multiple of kLanes.
void add_visible_clusters(const PixelView& view, const Nearness& nearness, const GridWindow& window,
                          const PackedMesh& mesh, const ClusterRange& range,
                          std::vector<VisibleCluster>& clusters);

}  // namespace glidar::raster
