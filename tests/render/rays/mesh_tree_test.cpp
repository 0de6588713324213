// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Hits depend on the mesh alone: not on tree, packet, kernel or threads.
#include <glidar/render/rays/mesh_tree.hpp>
#include <render/rays/caster.hpp>
#include <support/error_text.hpp>

#include <gtest/gtest.h>
#include <algorithm>
#include <cstring>

namespace glidar::rays::testing {
namespace {

using glidar::testing::aimed;
using glidar::testing::make_sphere;

MeshTree tree_of(const TestMesh& mesh, const TreeOptions& options = {}, unsigned threads = 2) {
  ThreadPool thread_pool(threads);
  return build_mesh_tree(view_of(mesh), options, thread_pool);
}

Traced trace(const MeshTree& tree, std::span<const TestRay> rays, const Kernel& kernel,
             unsigned packet_size = 16) {
  return trace_packets(rays, packet_size,
                       {kernel, tree.sphere, tree.view(),
                        [&](RayPacket& packet) { kernel.trace(tree.view(), packet); }});
}

std::size_t misses(const std::vector<HitCandidate>& hits) {
  return static_cast<std::size_t>(std::count_if(
      hits.begin(), hits.end(), [](const auto& hit) { return hit.primitive == kNoTriangle; }));
}

const Kernel& fastest() {
  return *usable_kernels().back();
}

/// FNV-1a of the triangles and of the bits of the distances.
std::uint64_t hash_of(const std::vector<HitCandidate>& hits) {
  std::uint64_t hash = 1469598103934665603U;
  for (const HitCandidate& hit : hits) {
    for (const std::uint64_t word :
         {std::uint64_t{hit.primitive}, std::bit_cast<std::uint64_t>(hit.distance)}) {
      hash = (hash ^ word) * 1099511628211U;
    }
  }
  return hash;
}

/// Traces rays by every kernel; all must find the same bits.
Traced trace_by_all(const MeshTree& tree, std::span<const TestRay> rays) {
  Traced traced = trace(tree, rays, fastest());
  const std::uint64_t expected = hash_of(traced.hits);
  for (const Kernel* kernel : usable_kernels()) {
    if (kernel == &fastest()) continue;
    EXPECT_EQ(hash_of(trace(tree, rays, *kernel).hits), expected) << kernel->name;
  }
  return traced;
}

/// Rays at vertices and edges of a mesh from one point, and some beside them.
std::vector<TestRay> aimed_rays(const TestMesh& mesh, const Eigen::Vector3d& origin,
                                std::size_t count, Numbers& numbers) {
  std::vector<TestRay> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d target = mesh.corner_or_edge(numbers);
    const double off = i % 4 == 0 ? 0.3 : 0.0;
    rays.push_back(aimed(origin, target + off * numbers.direction()));
  }
  return rays;
}

/// An image: neighbouring rays are similar, as those of a camera.
std::vector<TestRay> camera_rays(const Eigen::Vector3d& origin, unsigned side) {
  std::vector<TestRay> rays;
  for (unsigned tile = 0; tile < side * side / 16; ++tile) {
    for (unsigned i = 0; i < 16; ++i) {
      const unsigned column = tile % (side / 4) * 4 + i % 4;
      const unsigned row = tile / (side / 4) * 4 + i / 4;
      rays.push_back({origin, Eigen::Vector3d(1.2 * (column + 0.5) / side - 0.6,
                                              1.2 * (row + 0.5) / side - 0.6, -1.0)
                                  .normalized()});
    }
  }
  return rays;
}

/// A sphere with duplicates, coplanar overlapping plates through it, and triangles in any order.
TestMesh crowded_mesh(Numbers& numbers) {
  TestMesh mesh = make_sphere(4, 1.0, {0.0, 0.1, 0.0});
  const std::size_t count = mesh.triangles.size();
  for (std::size_t i = 0; i < count; i += 3) {
    const auto [a, b, c] = mesh.triangles[i];
    mesh.triangles.push_back({c, b, a});
  }
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& [x, y] : {std::pair{-2, -2}, {2, -2}, {2, 2}, {-2, 2}, {0, 0}}) {
    mesh.vertices.emplace_back(static_cast<float>(x), static_cast<float>(y), -0.3F);
  }
  for (const auto& [a, b, c] : std::initializer_list<std::array<std::uint32_t, 3>>{{0, 1, 2},
                                                                                   {0, 2, 3},
                                                                                   {0, 1, 3},
                                                                                   {1, 2, 3},
                                                                                   {0, 1, 4},
                                                                                   {1, 2, 4},
                                                                                   {2, 3, 4},
                                                                                   {3, 0, 4}}) {
    mesh.triangles.push_back({first + a, first + b, first + c});
  }
  for (std::size_t i = mesh.triangles.size() - 1; i > 0; --i) {
    std::swap(mesh.triangles[i], mesh.triangles[numbers.below(i + 1)]);
  }
  return mesh;
}

TEST(MeshTree, EqualsTheRuleForAllTriangles) {
  Numbers numbers(30);
  const TestMesh mesh = crowded_mesh(numbers);
  const MeshTree tree = tree_of(mesh);
  for (const double distance : {0.2, 2.4, 30.0, 1e5, 1e9}) {
    const Eigen::Vector3d origin = distance * Eigen::Vector3d(0.3, -0.4, 0.866);
    const std::vector<TestRay> rays = aimed_rays(mesh, origin, 1000, numbers);
    const Traced traced = trace(tree, rays, fastest());
    EXPECT_EQ(differences(traced.hits, trace_by_rule(mesh, rays)), 0U) << "from " << distance;
    EXPECT_LT(misses(traced.hits), 400U) << "from " << distance;
  }
}

TEST(MeshTree, HitsHaveTheSameBitsForAllTreesPacketsKernelsAndThreads) {
  Numbers numbers(31);
  const TestMesh mesh = crowded_mesh(numbers);
  std::vector<TestRay> rays = camera_rays({0.1, 0.2, 2.5}, 128);
  for (const TestRay& ray : aimed_rays(mesh, {0.4, 0.7, 1.9}, 20000, numbers)) rays.push_back(ray);
  for (int i = 0; i < 8000; ++i)
    rays.push_back(aimed(2.0 * numbers.direction(), numbers.in_cube(0.8)));
  const std::uint64_t expected = hash_of(trace(tree_of(mesh), rays, fastest()).hits);
  EXPECT_EQ(expected, 9042498125920698612U);
  for (const Kernel* kernel : usable_kernels()) {
    for (const TreeOptions& options :
         {TreeOptions{}, TreeOptions{32, 4}, TreeOptions{1, 2}, TreeOptions{16, 16}}) {
      const MeshTree tree = tree_of(mesh, options, options.bins / 4);
      for (const unsigned size : {16U, 5U, 1U}) {
        EXPECT_EQ(hash_of(trace(tree, rays, *kernel, size).hits), expected)
            << kernel->name << ", clusters of " << options.cluster_size << ", packets of " << size;
      }
      const Traced single =
          trace_packets(rays, 16, {*kernel, tree.sphere, tree.view(), [&](RayPacket& p) {
                                     kernel->trace_single(tree.view(), p);
                                   }});
      EXPECT_EQ(hash_of(single.hits), expected) << kernel->name << ", single rays";
    }
  }
}

TEST(MeshTree, IsTheSameForAnyNumberOfThreads) {
  const TestMesh mesh = make_sphere(6, 1.0, Eigen::Vector3d::Zero());  // enough for several tasks
  const MeshTree one = tree_of(mesh, {}, 1);
  const MeshTree four = tree_of(mesh, {}, 4);
  const auto are_same = [](const auto& a, const auto& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
  };
  EXPECT_TRUE(are_same(one.nodes, four.nodes));
  EXPECT_TRUE(are_same(one.clusters, four.clusters));
  EXPECT_TRUE(are_same(one.blocks, four.blocks));
}

TEST(MeshTree, BlocksAndNodesAreMostlyFull) {
  const TestMesh mesh = make_sphere(6, 1.0, Eigen::Vector3d::Zero());
  const MeshTree tree = tree_of(mesh);
  const double places = static_cast<double>(kBlockSize * tree.blocks.size());
  EXPECT_GT(static_cast<double>(mesh.triangles.size()) / places, 0.8);
  const double children = static_cast<double>(tree.nodes.size() - 1 + tree.clusters.size());
  EXPECT_GT(children / static_cast<double>(tree.nodes.size()), 5.0);
}

TEST(MeshTree, FourMillionRaysAtVerticesAndEdgesOfAClosedMeshDoNotLeak) {
  constexpr int kRounds = 20;  // of rays that fit into memory
  Numbers numbers(32);
  const Eigen::Vector3d centre(0.5, 0.2, 0.1);
  const TestMesh mesh = make_sphere(5, 1.0, centre);
  const MeshTree tree = tree_of(mesh);
  std::vector<TestRay> rays(200000);
  for (int round = 0; round < kRounds; ++round) {
    for (TestRay& ray : rays) {
      const Eigen::Vector3d target = mesh.corner_or_edge(numbers);
      Eigen::Vector3d from = Eigen::Vector3d(0.013, 0.21, -0.1);
      if (round % 4 == 1) from = numbers.in_cube(0.4);
      // From outside at the far half, so that no ray is tangent to the sphere.
      if (round % 4 == 2) from = -3.0 * (target - centre);
      if (round % 4 == 3) from = numbers.in_cube(0.4) - 1e4 * (target - centre);
      ray = aimed(centre + from, target);
    }
    ASSERT_EQ(misses(trace_by_all(tree, rays).hits), 0U) << "round " << round;
  }
}

TEST(MeshTree, ASensorAboveAPlanetSeesTheGroundBelowItWithinTheRoundingOfItsPosition) {
  Numbers numbers(33);
  constexpr double kPosition_m = 3e-9;  // of three coordinates of 6e6 m
  const double radius = 6.371e6;
  const TestMesh mesh = make_sphere(5, radius, Eigen::Vector3d::Zero());
  const MeshTree tree = tree_of(mesh);
  for (int i = 0; i < 50; ++i) {
    const HitTriangle t = mesh.triangle(numbers.below(mesh.triangles.size()));
    const auto point = [](const std::array<float, 3>& p) {
      return Eigen::Vector3d(double{p[0]}, double{p[1]}, double{p[2]});
    };
    const Eigen::Vector3d ground = (point(t.a) + point(t.b) + point(t.c)) / 3.0;
    Eigen::Vector3d up = (point(t.b) - point(t.a)).cross(point(t.c) - point(t.a)).normalized();
    if (up.dot(ground) < 0.0) up = -up;
    std::vector<TestRay> rays;
    const double height_m = i % 2 == 0 ? 1.5 : 0.01;
    for (int k = 0; k < 64; ++k) {
      Eigen::Vector3d direction = numbers.direction();
      if (direction.dot(up) > 0.0) direction = -direction;
      if (direction.dot(up) < -0.02) rays.push_back({ground + height_m * up, direction});
    }
    const Traced traced = trace_by_all(tree, rays);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const double slope = 1.0 / -rays[k].direction.dot(up);
      const double expected = height_m * slope;
      ASSERT_NEAR(traced.hits[k].distance, expected, kPosition_m * slope + 1e-7 * expected);
    }
  }
}

TEST(MeshTree, ASensorOnAVertexSeesNeitherThatVertexNorThroughTheMesh) {
  Numbers numbers(34);
  const TestMesh mesh = make_sphere(4, 1.0, Eigen::Vector3d::Zero());
  const MeshTree tree = tree_of(mesh);
  std::vector<TestRay> rays;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d vertex =
        mesh.vertices[numbers.below(mesh.vertices.size())].cast<double>();
    const Eigen::Vector3d direction = numbers.direction();
    if (std::abs(direction.dot(vertex)) > 0.05) rays.push_back({vertex, direction});
  }
  const Traced traced = trace_by_all(tree, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double inwards = -rays[i].direction.dot(rays[i].origin);
    ASSERT_EQ(traced.hits[i].primitive != kNoTriangle, inwards > 0.0);
    if (inwards > 0.0) {
      ASSERT_NEAR(traced.hits[i].distance, 2.0 * inwards, 0.05);
    }
  }
}

TEST(MeshTree, FindsWhetherAPointTouchesATriangle) {
  TestMesh mesh;
  mesh.vertices = {{0, 0, 0}, {4, 0, 4}, {0, 4, 4}, {9, 9, 9}};
  mesh.triangles = {{0, 1, 2}};
  const MeshTree tree = tree_of(mesh);
  const Eigen::Vector3d on(1, 1, 2);  // z = x + y
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 1, -1).normalized();
  EXPECT_TRUE(may_touch_triangle(tree, on, 1e-12));
  EXPECT_TRUE(may_touch_triangle(tree, on + 0.9e-6 * normal, 1e-6));
  EXPECT_FALSE(may_touch_triangle(tree, on + 1.1e-6 * normal, 1e-6)) << "in its box only";
  EXPECT_FALSE(may_touch_triangle(tree, {5, 0, 5}, 0.5)) << "in its plane only";
  mesh.triangles = {{0, 3, 0}};
  EXPECT_TRUE(may_touch_triangle(tree_of(mesh), {3, 4, 5}, 0.0)) << "without area";
}

TEST(MeshTree, AcceptsMeshesOfEverySize) {
  Numbers numbers(35);
  for (const std::uint32_t count : {0U, 1U, 2U, 8U, 9U, 63U, 65U, 700U}) {
    TestMesh mesh = make_sphere(3, 1.0, Eigen::Vector3d::Zero());
    mesh.triangles.resize(count);
    const MeshTree tree = tree_of(mesh);
    if (count == 0) {
      EXPECT_TRUE(tree.nodes.empty());
      continue;
    }
    const std::vector<TestRay> rays = aimed_rays(mesh, {0.1, 0.1, 0.1}, 100, numbers);
    EXPECT_EQ(differences(trace(tree, rays, fastest()).hits, trace_by_rule(mesh, rays)), 0U)
        << count << " triangles";
  }
}

TEST(MeshTree, AcceptsManyTrianglesAtOnePosition) {
  TestMesh mesh;
  mesh.vertices = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  mesh.triangles.assign(5000, {0, 1, 2});
  const MeshTree tree = tree_of(mesh);
  const std::vector<TestRay> rays = {{{0.2, 0.2, 0.0}, {0, 0, 1}}, {{2.0, 0.2, 0.0}, {0, 0, 1}}};
  const Traced traced = trace(tree, rays, fastest());
  EXPECT_EQ(traced.hits[0].primitive, 0U) << "the lowest of equal ones";
  EXPECT_EQ(traced.hits[1].primitive, kNoTriangle);
}

TEST(MeshTree, ItsDepthIsWithinTheStackOfTheKernels) {
  TestMesh mesh;  // triangles that halve in size: each cut takes few of them
  for (std::uint32_t i = 0; i < 240; ++i) {
    const float size = std::ldexp(1.0F, 90 - static_cast<int>(i));
    mesh.vertices.insert(mesh.vertices.end(), {{size, 0, 0}, {size, size, 0}, {size, 0, size}});
    for (int k = 0; k < 9; ++k) mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const MeshTree tree = tree_of(mesh, {.cluster_size = 1, .bins = 16});
  std::vector<unsigned> depth(tree.nodes.size(), 1);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    for (const std::int32_t child : tree.nodes[i].child) {
      if (child >= 0) depth[static_cast<std::size_t>(child)] = depth[i] + 1;
    }
  }
  EXPECT_LE(*std::max_element(depth.begin(), depth.end()), kMaxTreeDepth);
  const std::vector<TestRay> rays = {{{-1, 0.1, 0.1}, {1, 0, 0}}};
  EXPECT_EQ(differences(trace(tree, rays, fastest()).hits, trace_by_rule(mesh, rays)), 0U);
}

TEST(MeshTree, VerticesBeyondSinglePrecisionBoxesAreAnError) {
  TestMesh mesh = make_sphere(0, 1.0, Eigen::Vector3d::Zero());
  mesh.vertices[5].y() = 1e30F;
  EXPECT_EQ(error_text([&] { tree_of(mesh); }),
            "vertex 5 of a mesh: a coordinate is 1.0000000150474662e+30; allowed: up to "
            "7.922816251426434e+28; choose another unit, or another origin");
}

}  // namespace
}  // namespace glidar::rays::testing
