// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/exact_test.hpp>
#include <glidar/render/rays/kernels.hpp>
#include <render/common/rays.hpp>

#include <bit>
#include <functional>
#include <span>
#include <vector>

namespace glidar::rays::testing {

using glidar::testing::Numbers;
using glidar::testing::TestMesh;
using glidar::testing::TestRay;

inline MeshTriangles view_of(const TestMesh& mesh) {
  return {mesh.vertices, mesh.triangles};
}

/// A sphere around the box of the vertices.
MeshSphere sphere_of(const TestMesh& mesh);

/// Clusters of consecutive triangles, without a tree.
struct FlatClusters {
  std::vector<TriangleCluster> clusters;
  std::vector<TriangleBlock> blocks;

  FlatClusters(const TestMesh& mesh, std::uint32_t cluster_size);
  [[nodiscard]] TreeView view() const { return {nullptr, clusters.data(), blocks.data()}; }
};

/// Hits of traced rays.
struct Traced {
  std::vector<HitCandidate> hits;  ///< one per ray; primitive kNoTriangle: nothing, at distance 0
  std::size_t exact_tests = 0;     ///< number of applications of the rule
};

/// What to trace, and how.
struct Tracer {
  const Kernel& kernel;
  MeshSphere sphere;
  TreeView tree;
  std::function<void(RayPacket&)> trace;
};

/// Divides rays into packets of up to `size` and traces them.
Traced trace_packets(std::span<const TestRay> rays, unsigned size, const Tracer& tracer);

/// Hits by the rule alone, without any filter.
std::vector<HitCandidate> trace_by_rule(const TestMesh& mesh, std::span<const TestRay> rays);

inline bool are_equal(const HitCandidate& a, const HitCandidate& b) {
  return a.primitive == b.primitive &&
         std::bit_cast<std::uint64_t>(a.distance) == std::bit_cast<std::uint64_t>(b.distance);
}

/// Number of rays whose hits differ in any bit.
std::size_t differences(const std::vector<HitCandidate>& a, const std::vector<HitCandidate>& b);

}  // namespace glidar::rays::testing
