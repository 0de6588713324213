// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/common/triangle_blocks.hpp>

#include <glidar/render/common/rounding.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace glidar {
namespace {

Eigen::AlignedBox3f box_of(const MeshTriangles& mesh, std::span<const std::uint32_t> chosen) {
  Eigen::AlignedBox3f box;
  for (const std::uint32_t t : chosen) {
    for (const std::uint32_t v : mesh.triangles[t]) box.extend(mesh.positions[v]);
  }
  return box;
}

}  // namespace

void pack_cluster(const MeshTriangles& mesh, std::span<std::uint32_t> chosen,
                  TriangleCluster& cluster, std::vector<TriangleBlock>& blocks) {
  std::sort(chosen.begin(), chosen.end());
  const Eigen::AlignedBox3f box = box_of(mesh, chosen);
  double radius = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min()[axis];
    const double high = box.max()[axis];
    const auto centre = static_cast<float>(0.5 * (low + high));
    cluster.centre[axis] = centre;
    radius = std::max({radius, high - double{centre}, double{centre} - low});
  }
  cluster.radius = next_above(radius);
  cluster.count = static_cast<std::uint32_t>(chosen.size());
  for (std::uint32_t slot = 0; slot < kBlockSize * block_count(cluster.count); ++slot) {
    const std::uint32_t t = chosen[std::min(slot, cluster.count - 1)];
    TriangleBlock& block = blocks[cluster.first_block + slot / kBlockSize];
    const unsigned i = slot % kBlockSize;
    block.primitive[i] = mesh.first_primitive + t;
    for (unsigned k = 0; k < 3; ++k) {
      const Eigen::Vector3f& p = mesh.positions[mesh.triangles[t][k]];
      for (unsigned axis = 0; axis < 3; ++axis) block.corner[k][axis][i] = p[axis];
    }
  }
}

}  // namespace glidar
