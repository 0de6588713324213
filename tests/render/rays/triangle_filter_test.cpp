// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Filter and rule together equal the rule alone, bit for bit, with every kernel. The
// library asserts that the rule never rejects a triangle that the filter accepted.
#include <render/rays/caster.hpp>
#include <support/parameter_name.hpp>

#include <gtest/gtest.h>
#include <algorithm>

namespace glidar::rays {

inline void PrintTo(const Kernel* kernel, std::ostream* out) {
  *out << kernel->name;
}

}  // namespace glidar::rays

namespace glidar::rays::testing {
namespace {

/// A mesh and rays that are hard for it.
struct Case {
  std::string name;
  TestMesh mesh;
  std::vector<TestRay> rays;
};

TestMesh add(TestMesh a, const TestMesh& b) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) {
    a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return a;
}

/// Triangles of all sizes and shapes, among them needles, flat ones and duplicates.
TestMesh make_soup(std::size_t count, double size, Numbers& numbers) {
  TestMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Eigen::Vector3d place = numbers.in_cube(size);
    const double small = size * std::abs(numbers.of_any_size(-24, 1));
    for (int k = 0; k < 3; ++k) {
      const double thin = k == 2 && i % 4 == 0 ? 1e-6 : 1.0;
      mesh.vertices.push_back((place + thin * numbers.in_cube(small)).cast<float>());
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    if (i % 7 == 0) mesh.triangles.push_back({3 * i + 1, 3 * i, 3 * i + 2});
    if (i % 11 == 0) mesh.triangles.push_back({3 * i, 3 * i, 3 * i + 1});
  }
  return mesh;
}

Eigen::Vector3d centre_of(const MeshSphere& sphere) {
  return Eigen::Map<const Eigen::Vector3d>(sphere.centre);
}

/// Tests every cluster.
Traced trace_flat(const FlatClusters& flat, const Case& c, const Kernel& kernel, unsigned size) {
  return trace_packets(c.rays, size, {kernel, sphere_of(c.mesh), flat.view(), [&](RayPacket& p) {
                                        for (std::uint32_t i = 0; i < flat.clusters.size(); ++i) {
                                          kernel.test_leaf(flat.view(), i, p, p.active);
                                        }
                                      }});
}

/// Rays from one point, or from separate ones; a third at vertices and edges, a third near them,
/// some along edges, where triangles are seen edge-on.
std::vector<TestRay> make_rays(const TestMesh& mesh, std::size_t count, double distance,
                               bool is_common, Numbers& numbers) {
  const MeshSphere sphere = sphere_of(mesh);
  std::vector<TestRay> rays;
  Eigen::Vector3d origin;
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_common || i % 16 == 0) {
      origin = centre_of(sphere) + distance * sphere.radius * numbers.direction();
    }
    Eigen::Vector3d target = mesh.corner_or_edge(numbers);
    if (i % 3 == 1) target += 1e-6 * sphere.radius * numbers.in_cube(1.0);
    if (i % 3 == 2) target = centre_of(sphere) + numbers.in_cube(0.6 * sphere.radius);
    if (i % 50 == 49) {
      const auto& t = mesh.triangles[numbers.below(mesh.triangles.size())];
      const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
      const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>();
      target = is_common ? a : b + 2.0 * (b - a);
      if (!is_common) origin = a - 3.0 * (b - a);
    }
    if ((target - origin).norm() > 0.0) rays.push_back(glidar::testing::aimed(origin, target));
  }
  return rays;
}

std::vector<Case> make_cases() {
  Numbers numbers(20);
  std::vector<Case> cases;
  const auto put = [&](const std::string& name, const TestMesh& mesh, double distance,
                       std::size_t count) {
    for (const bool is_common : {true, false}) {
      cases.push_back({name + (is_common ? ", common origin" : ", own origins"), mesh,
                       make_rays(mesh, count, distance, is_common, numbers)});
    }
  };
  const TestMesh sphere = glidar::testing::make_sphere(2, 1.0, {0.3, -0.2, 0.1});
  put("sphere from inside", sphere, 0.3, 6000);
  put("sphere from outside", sphere, 3.0, 6000);
  put("sphere from 50 radii", sphere, 50.0, 3000);
  put("sphere from 1e6 radii", sphere, 1e6, 3000);
  put("sphere from 1e12 radii", sphere, 1e12, 1000);
  put("soup", make_soup(300, 1.0, numbers), 1.0, 6000);
  put("soup of a planet's size", make_soup(300, 6.4e6, numbers), 1.0, 3000);
  put("soup of an atom's size", make_soup(300, 1e-10, numbers), 1.0, 2000);
  put("soup of denormal size", make_soup(200, 1e-39, numbers), 2.0, 1000);
  put("soup of a galaxy's size", make_soup(200, 1e20, numbers), 1.0, 1000);
  const TestMesh far_sphere = glidar::testing::make_sphere(1, 0.01, {1000.0, 2000.0, -500.0});
  put("small thing in a large mesh", add(make_soup(100, 3000.0, numbers), far_sphere), 0.5, 3000);
  return cases;
}

class TriangleFilter : public ::testing::TestWithParam<const Kernel*> {};

TEST_P(TriangleFilter, EqualsTheRule) {
  for (const Case& c : make_cases()) {
    const std::vector<HitCandidate> expected = trace_by_rule(c.mesh, c.rays);
    const auto misses = std::count_if(expected.begin(), expected.end(),
                                      [](const auto& hit) { return hit.distance == 0.0; });
    EXPECT_LT(static_cast<std::size_t>(misses), c.rays.size()) << c.name;
    for (const std::uint32_t cluster_size : {8U, 13U}) {
      const FlatClusters flat(c.mesh, cluster_size);
      for (const unsigned packet_size : {16U, 7U, 1U}) {
        const Traced traced = trace_flat(flat, c, *GetParam(), packet_size);
        EXPECT_EQ(differences(traced.hits, expected), 0U)
            << c.name << ", packets of " << packet_size << ", clusters of " << cluster_size;
      }
    }
  }
}

TEST_P(TriangleFilter, LeavesFewTrianglesToTheRule) {
  Numbers numbers(21);
  Case c{"sphere", glidar::testing::make_sphere(3, 1.0, Eigen::Vector3d::Zero()), {}};
  for (int i = 0; i < 16000; ++i) {
    c.rays.push_back(glidar::testing::aimed({0.1, 0.2, 2.5}, numbers.in_cube(0.5)));
  }
  const Traced traced = trace_flat(FlatClusters(c.mesh, 8), c, *GetParam(), 16);
  EXPECT_LT(traced.exact_tests, c.rays.size() / 200);
}

INSTANTIATE_TEST_SUITE_P(Kernels, TriangleFilter, ::testing::ValuesIn(usable_kernels()),
                         glidar::testing::parameter_name<const Kernel*>);

TEST(Kernels, AnUnknownNameIsAnErrorThatListsTheUsableOnes) {
  EXPECT_EQ(std::string(find_kernel("baseline").name), "baseline");
  EXPECT_EQ(std::string(find_kernel("").name), usable_kernels().back()->name);
  try {
    find_kernel("sse9");
    FAIL() << "no error";
  } catch (const std::exception& error) {
    EXPECT_EQ(std::string(error.what())
                  .rfind("environment variable GLIDAR_ISA: this processor has no "
                         "kernel 'sse9'; allowed: baseline",
                         0),
              0U)
        << error.what();
  }
}

}  // namespace
}  // namespace glidar::rays::testing
