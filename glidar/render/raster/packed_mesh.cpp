// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/raster/packed_mesh.hpp>

#include <glidar/render/planes.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace glidar::raster {
namespace {

constexpr std::size_t kClusterTriangles = kPacketsPerCluster * kLanes;

Eigen::Vector3f corner(const Mesh& mesh, std::uint32_t triangle, std::size_t k) {
  return mesh.positions_m[mesh.triangles[triangle][k]];
}

/// A triangle and its centroid.
struct TriangleCentroid {
  Eigen::Vector3f middle;
  std::uint32_t triangle;
};

/// Centroids of the chosen triangles that have a plane.
std::vector<TriangleCentroid> centroids(const Mesh& mesh, std::span<const std::uint32_t> chosen) {
  const std::size_t count = chosen.empty() ? mesh.triangles.size() : chosen.size();
  std::vector<TriangleCentroid> all;
  all.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t t = chosen.empty() ? i : chosen[i];
    if (std::isnan(plane_of(mesh, t).normal.x())) continue;
    constexpr float kThird =
        1.0F / 3.0F;  // before the sum, which would overflow for large coordinates
    all.push_back(
        {kThird * corner(mesh, t, 0) + kThird * corner(mesh, t, 1) + kThird * corner(mesh, t, 2),
         t});
  }
  return all;
}

/// Sorts triangles so that neighbours are adjacent: halves across the longest side, recursively,
/// down to clusters and packets.
void sort_spatially(std::span<TriangleCentroid> all) {
  if (all.size() <= kLanes) return;
  Eigen::AlignedBox3f box;
  for (const TriangleCentroid& centroid : all) box.extend(centroid.middle);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t whole = all.size() > kClusterTriangles ? kClusterTriangles : kLanes;
  const std::size_t half = (all.size() + whole - 1) / whole / 2 * whole;
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(half), all.end(),
                   [axis](const TriangleCentroid& a, const TriangleCentroid& b) {
                     return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis]
                                                             : a.triangle < b.triangle;
                   });
  sort_spatially(all.first(half));
  sort_spatially(all.subspan(half));
}

/// Sets the box of one lane and returns its middle.
Eigen::Vector3f set_box(const Mesh& mesh, std::span<const TriangleCentroid> members, unsigned lane,
                        BoxPacket& boxes) {
  Eigen::AlignedBox3f box;
  for (const TriangleCentroid& centroid : members) {
    for (std::size_t k = 0; k < 3; ++k) box.extend(corner(mesh, centroid.triangle, k));
  }
  // Halved before the sum, which would overflow for large coordinates.
  const Eigen::Vector3f middle = 0.5F * box.min() + 0.5F * box.max();
  const Eigen::Vector3f half = (box.max() - middle).cwiseMax(middle - box.min());
  constexpr float kBoxMargin = 1.0F + 4.0F * std::numeric_limits<float>::epsilon();
  boxes.middle.set(lane, middle);
  boxes.half.set(lane, kBoxMargin * half);
  return middle;
}

TrianglePacket pack_triangles(const Mesh& mesh, std::span<const TriangleCentroid> members,
                              const Eigen::Vector3f& middle) {
  TrianglePacket packed;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    const std::uint32_t triangle =
        members[std::min<std::size_t>(lane, members.size() - 1)].triangle;
    packed.primitive[lane] = triangle;
    packed.corners.c0.set(lane, corner(mesh, triangle, 0) - middle);
    packed.corners.c1.set(lane, corner(mesh, triangle, 1) - middle);
    packed.corners.c2.set(lane, corner(mesh, triangle, 2) - middle);
  }
  return packed;
}

}  // namespace

PackedMesh::PackedMesh(const Mesh& mesh, std::span<const std::uint32_t> chosen) {
  std::vector<TriangleCentroid> sorted = centroids(mesh, chosen);
  sort_spatially(sorted);
  const std::span<const TriangleCentroid> all(sorted);
  clusters = (all.size() + kClusterTriangles - 1) / kClusterTriangles;
  packets.reserve((all.size() + kLanes - 1) / kLanes);
  boxes.resize((clusters + kLanes - 1) / kLanes, BoxPacket{});
  for (std::size_t cluster = 0; cluster < clusters; ++cluster) {
    const std::size_t begin = cluster * kClusterTriangles;
    const auto members = all.subspan(begin, std::min(kClusterTriangles, all.size() - begin));
    const Eigen::Vector3f middle =
        set_box(mesh, members, static_cast<unsigned>(cluster % kLanes), boxes[cluster / kLanes]);
    for (std::size_t i = 0; i < members.size(); i += kLanes) {
      packets.push_back(pack_triangles(
          mesh, members.subspan(i, std::min<std::size_t>(kLanes, members.size() - i)), middle));
    }
  }
}

}  // namespace glidar::raster
