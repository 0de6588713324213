// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <render/rays/caster.hpp>

#include <algorithm>
#include <numeric>

namespace glidar::rays::testing {

MeshSphere sphere_of(const TestMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& p : mesh.vertices) box.extend(p.cast<double>());
  const Eigen::Vector3d c = box.center();
  return {{c.x(), c.y(), c.z()}, 0.5 * box.sizes().norm() * (1.0 + 1e-12)};
}

FlatClusters::FlatClusters(const TestMesh& mesh, std::uint32_t cluster_size) {
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t i = 0; i < order.size(); i += cluster_size) {
    const std::size_t count = std::min<std::size_t>(cluster_size, order.size() - i);
    TriangleCluster& cluster = clusters.emplace_back();
    cluster.first_block = static_cast<std::uint32_t>(blocks.size());
    blocks.resize(blocks.size() + block_count(static_cast<std::uint32_t>(count)));
    pack_cluster(view_of(mesh), std::span(order).subspan(i, count), cluster, blocks);
  }
}

Traced trace_packets(std::span<const TestRay> rays, unsigned size, const Tracer& tracer) {
  Traced traced;
  RayPacket packet;
  for (std::size_t first = 0; first < rays.size(); first += size) {
    const auto count = static_cast<unsigned>(std::min<std::size_t>(size, rays.size() - first));
    for (unsigned i = 0; i < count; ++i) {
      set_ray(packet, i, rays[first + i].origin, rays[first + i].direction);
    }
    tracer.kernel.start(packet, tracer.sphere, (1U << count) - 1U);
    tracer.trace(packet);
    traced.exact_tests += packet.exact_tests;
    complete_distances(tracer.tree.blocks, packet);
    for (unsigned i = 0; i < count; ++i) {
      const std::uint32_t primitive = primitive_of(tracer.tree.blocks, packet, i);
      traced.hits.push_back({primitive == kNoTriangle ? 0.0 : packet.distance[i], 0, primitive});
    }
  }
  return traced;
}

std::vector<HitCandidate> trace_by_rule(const TestMesh& mesh, std::span<const TestRay> rays) {
  std::vector<HitCandidate> hits;
  for (const TestRay& ray : rays) {
    HitCandidate hit = nearest_of_all(mesh, ray);
    if (hit.primitive == UINT32_MAX) hit.distance = 0.0;
    hits.push_back(hit);
  }
  return hits;
}

std::size_t differences(const std::vector<HitCandidate>& a, const std::vector<HitCandidate>& b) {
  std::size_t count = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    count += static_cast<std::size_t>(!are_equal(a[i], b[i]));
  }
  return count;
}

}  // namespace glidar::rays::testing
