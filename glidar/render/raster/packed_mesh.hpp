// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/resolver.hpp>

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

}  // namespace glidar::raster
