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

constexpr std::size_t kClusterTriangles = kPacksPerCluster * kLanes;

Eigen::Vector3f corner(const Mesh& mesh, std::uint32_t triangle, std::size_t k) {
  return mesh.positions_m[mesh.triangles[triangle][k]];
}

/// A triangle and where it is.
struct Place {
  Eigen::Vector3f middle;
  std::uint32_t triangle;
};

/// Those of the chosen with a plane.
std::vector<Place> places(const Mesh& mesh, std::span<const std::uint32_t> chosen) {
  const std::vector<TrianglePlane> planes = triangle_planes(mesh);
  const std::size_t count = chosen.empty() ? mesh.triangles.size() : chosen.size();
  std::vector<Place> all;
  all.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t t = chosen.empty() ? i : chosen[i];
    if (std::isnan(planes[t].normal.x())) continue;
    constexpr float kThird = 1.0F / 3.0F;  // before the sum: that of large ones would overflow
    all.push_back(
        {kThird * corner(mesh, t, 0) + kThird * corner(mesh, t, 1) + kThird * corner(mesh, t, 2),
         t});
  }
  return all;
}

/// Puts triangles that lie near each other next to each other: halves across the longest side, and
/// so on, down to clusters and packs.
void sort_in_space(std::span<Place> all) {
  if (all.size() <= kLanes) return;
  Eigen::AlignedBox3f box;
  for (const Place& place : all) box.extend(place.middle);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t whole = all.size() > kClusterTriangles ? kClusterTriangles : kLanes;
  const std::size_t half = (all.size() + whole - 1) / whole / 2 * whole;
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(half), all.end(),
                   [axis](const Place& a, const Place& b) {
                     return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis]
                                                             : a.triangle < b.triangle;
                   });
  sort_in_space(all.first(half));
  sort_in_space(all.subspan(half));
}

/// Sets the box of one lane and returns its middle.
Eigen::Vector3f surround(const Mesh& mesh, std::span<const Place> own, unsigned lane,
                         Boxes& boxes) {
  Eigen::AlignedBox3f box;
  for (const Place& place : own) {
    for (std::size_t k = 0; k < 3; ++k) box.extend(corner(mesh, place.triangle, k));
  }
  // Halves first: the sum of large ones would overflow.
  const Eigen::Vector3f middle = 0.5F * box.min() + 0.5F * box.max();
  const Eigen::Vector3f half = (box.max() - middle).cwiseMax(middle - box.min());
  constexpr float kPackedRoom = 1.0F + 4.0F * std::numeric_limits<float>::epsilon();
  boxes.middle.set(lane, middle);
  boxes.half.set(lane, kPackedRoom * half);
  return middle;
}

Pack pack(const Mesh& mesh, std::span<const Place> own, const Eigen::Vector3f& middle) {
  Pack packed;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    const std::uint32_t triangle = own[std::min<std::size_t>(lane, own.size() - 1)].triangle;
    packed.primitive[lane] = triangle;
    packed.corners.c0.set(lane, corner(mesh, triangle, 0) - middle);
    packed.corners.c1.set(lane, corner(mesh, triangle, 1) - middle);
    packed.corners.c2.set(lane, corner(mesh, triangle, 2) - middle);
  }
  return packed;
}

}  // namespace

PackedMesh::PackedMesh(const Mesh& mesh, std::span<const std::uint32_t> chosen) {
  std::vector<Place> sorted = places(mesh, chosen);
  sort_in_space(sorted);
  const std::span<const Place> all(sorted);
  clusters = (all.size() + kClusterTriangles - 1) / kClusterTriangles;
  packs.reserve((all.size() + kLanes - 1) / kLanes);
  boxes.resize((clusters + kLanes - 1) / kLanes, Boxes{});
  for (std::size_t cluster = 0; cluster < clusters; ++cluster) {
    const std::size_t begin = cluster * kClusterTriangles;
    const auto own = all.subspan(begin, std::min(kClusterTriangles, all.size() - begin));
    const Eigen::Vector3f middle =
        surround(mesh, own, static_cast<unsigned>(cluster % kLanes), boxes[cluster / kLanes]);
    for (std::size_t i = 0; i < own.size(); i += kLanes) {
      packs.push_back(
          pack(mesh, own.subspan(i, std::min<std::size_t>(kLanes, own.size() - i)), middle));
    }
  }
}

}  // namespace glidar::raster
