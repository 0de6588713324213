// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/render/grid_window.hpp>
#include <glidar/render/raster/tile_buffer.hpp>
#include <glidar/render/resolver.hpp>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar::raster {

/// Triangles that are processed together, one per lane. Unused lanes repeat the last triangle.
struct TrianglePacket {
  CornerBlock corners;  ///< relative to the cluster's middle, object units
  std::array<std::uint32_t, kLanes> primitive;
};

inline constexpr std::size_t kPacketsPerCluster = 4;

/// Boxes around kLanes clusters, object units; unused lanes are points.
struct BoxPacket {
  Lanes3<float> middle;  ///< relative to the mesh's origin
  Lanes3<float> half;    ///< of their sizes
};

/// A mesh divided into clusters of neighbouring triangles, so that many triangles are culled at
/// once. Triangles without area, which nothing can hit, are left out.
struct PackedMesh {
  /// `chosen`: indices of the triangles to use; empty: all.
  explicit PackedMesh(const Mesh& mesh, std::span<const std::uint32_t> chosen = {});

  std::vector<TrianglePacket> packets;  ///< kPacketsPerCluster per cluster, fewer in the last
  std::size_t clusters = 0;
  std::vector<BoxPacket> boxes;  ///< per kLanes clusters
};

/// An instance as seen by a pinhole camera.
struct PixelView {
  /// From a point relative to the mesh's origin to (column, row, 1) times its depth, m.
  Eigen::Matrix<double, 3, 4> pixel_from_object;
};

PixelView pixel_view(const InstanceView& view, const PinholeIntrinsics& pinhole);

/// Reversed depth: near (far - z) / (z (far - near)), 1 at the near plane, 0 at the far one, and
/// larger for points nearer than the near plane. It is linear in column and row.
struct Nearness {
  explicit Nearness(const DepthRange& depths)
      : far_m(depths.far_m), factor(depths.near_m / (depths.far_m - depths.near_m)) {}
  double far_m;
  double factor;

  [[nodiscard]] double at(double depth_m) const { return factor * (far_m - depth_m) / depth_m; }
};

/// Bounds of kLanes clusters in the image: columns and rows, both ends included, and the maximum
/// nearness. An empty range of columns: not visible.
struct ClusterBounds {
  Lanes<std::int32_t> left;
  Lanes<std::int32_t> right;
  Lanes<std::int32_t> top;
  Lanes<std::int32_t> bottom;
  Lanes<float> nearness;
};

/// Finds them from the boxes of clusters, within a window of the image.
void bound_clusters(const PixelView& view, const Nearness& nearness, const GridWindow& window,
                    const BoxPacket& boxes, ClusterBounds& bounds);

/// A range of an instance's clusters.
struct ClusterRange {
  std::uint32_t instance;
  std::uint32_t first;
  std::uint32_t end;
};

/// A cluster that may be visible, with its columns and rows in the image, both ends included.
struct VisibleCluster {
  std::uint32_t instance;
  std::uint32_t cluster;
  std::int32_t left;
  std::int32_t right;
  std::int32_t top;
  std::int32_t bottom;
  float nearness;  ///< maximum; infinite where the cluster reaches the sensor's plane
};

/// True when nothing of a cluster's box, which may reach behind the sensor, is in the rectangle of
/// pixels, both ends included.
bool is_outside(const PixelView& view, const BoxPacket& boxes, unsigned lane,
                const PixelBounds& pixels);

/// Adds the clusters of the range that may be visible; its first index is a multiple of kLanes.
void add_visible_clusters(const PixelView& view, const Nearness& nearness, const GridWindow& window,
                          const PackedMesh& mesh, const ClusterRange& range,
                          std::vector<VisibleCluster>& clusters);

}  // namespace glidar::raster
