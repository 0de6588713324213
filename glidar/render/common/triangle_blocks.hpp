// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>
#include <glidar/render/common/hit_rule.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// How many triangles a block holds.
inline constexpr unsigned kBlockSize = 8;

/// Eight triangles side by side, corners as in the mesh: five cache lines. Unused places of a
/// cluster's last block repeat its last triangle.
struct alignas(64) TriangleBlock {
  float corner[3][3][kBlockSize];       ///< corner a, b, c; then x, y, z; then triangle
  std::uint32_t primitive[kBlockSize];  ///< index in the mesh
};
static_assert(sizeof(TriangleBlock) == 320);

/// Neighbouring triangles: the leaf of a tree.
struct TriangleCluster {
  float centre[3];
  float radius;  ///< at least the largest |p_i - centre_i| of a corner p
  std::uint32_t first_block;
  std::uint32_t count;  ///< triangles, at least 1
};
static_assert(sizeof(TriangleCluster) == 24);

/// The triangles of a mesh, or of a part with its own origin (see Mesh::origins).
struct MeshTriangles {
  std::span<const Eigen::Vector3f> positions;
  std::span<const Triangle> triangles;
  std::uint32_t first_primitive = 0;           ///< index in the mesh of triangles[0]
  std::span<const std::uint32_t> chosen = {};  ///< indices of those to use; empty: all
};

/// Number of blocks for `count` triangles.
inline std::uint32_t block_count(std::uint32_t count) {
  return (count + kBlockSize - 1) / kBlockSize;
}

/// Copies triangles of a mesh into blocks that begin at cluster.first_block of `blocks`, in rising
/// order, and sets the cluster's centre, radius and count. `chosen`: indices into mesh.triangles,
/// at least one; they are sorted.
void pack_cluster(const MeshTriangles& mesh, std::span<std::uint32_t> chosen,
                  TriangleCluster& cluster, std::vector<TriangleBlock>& blocks);

/// A triangle of a mesh, relative to its origin.
inline HitTriangle corners_of(const Mesh& mesh, std::uint32_t triangle) {
  const auto corner = [&](std::size_t k) {
    const Eigen::Vector3f& p = mesh.positions_m[mesh.triangles[triangle][k]];
    return std::array<float, 3>{p.x(), p.y(), p.z()};
  };
  return {corner(0), corner(1), corner(2)};
}

/// A triangle by its slot: kBlockSize * block + index in the block.
inline HitTriangle triangle_at(const TriangleBlock* blocks, std::uint32_t slot) {
  const TriangleBlock& block = blocks[slot / kBlockSize];
  const unsigned i = slot % kBlockSize;
  const auto corner = [&](unsigned k) {
    return std::array<float, 3>{block.corner[k][0][i], block.corner[k][1][i],
                                block.corner[k][2][i]};
  };
  return {corner(0), corner(1), corner(2)};
}

}  // namespace glidar
