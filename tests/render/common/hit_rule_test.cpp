// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The hit rule is watertight, and independent of the order of corners and of the processor.
// hit_rule_test.py compares it with rational arithmetic.
#include <glidar/render/common/hit_rule.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/double_double.hpp>
#include <glidar/render/common/hit_arithmetic.hpp>
#include <render/common/rays.hpp>
#include <support/error_text.hpp>

#include <gtest/gtest.h>
#include <bit>
#include <limits>

namespace glidar {
namespace {

using testing::aimed;
using testing::make_fan;
using testing::make_sphere;
using testing::nearest_of_all;
using testing::Numbers;
using testing::TestMesh;
using testing::TestRay;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double distance_of(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                   const HitTriangle& triangle) {
  return hit_distance(make_hit_ray(origin, direction), triangle);
}

HitTriangle unit_triangle() {
  return {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}};
}

/// A triangle of small integers, many of them flat or seen edge-on.
HitTriangle lattice_triangle(Numbers& numbers) {
  const auto corner = [&] {
    return std::array<float, 3>{static_cast<float>(numbers.below(5)) - 2.0F,
                                static_cast<float>(numbers.below(5)) - 2.0F,
                                static_cast<float>(numbers.below(5)) - 2.0F};
  };
  return {corner(), corner(), corner()};
}

TestRay lattice_ray(Numbers& numbers) {
  TestRay ray{};
  do {
    for (int k = 0; k < 3; ++k) {
      ray.origin[k] = static_cast<double>(numbers.below(9)) - 4.0;
      ray.direction[k] = static_cast<double>(numbers.below(3)) - 1.0;
    }
  } while (ray.direction.isZero());
  return ray;
}

TEST(HitRule, DistanceIsExactWhereNothingRounds) {
  const HitTriangle triangle = unit_triangle();
  EXPECT_EQ(distance_of({0.25, 0.25, 0}, {0, 0, 1}, triangle), 2.0);
  EXPECT_EQ(distance_of({0.25, 0.25, 5}, {0, 0, -1}, triangle), 3.0);
  EXPECT_EQ(distance_of({0.25, 0.25, 0}, {0, 0, 0.5}, triangle), 4.0) << "in lengths of d";
}

TEST(HitRule, EdgesBelongToTheTriangle) {
  const HitTriangle triangle = unit_triangle();
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {0.5, 0.0}, {0.5, 0.5}}) {
    EXPECT_EQ(distance_of({x, y, 0}, {0, 0, 1}, triangle), 2.0) << x << ' ' << y;
  }
  EXPECT_EQ(distance_of({-0x1p-1000, 0.5, 0}, {0, 0, 1}, triangle), 2.0) << "counts as zero";
  EXPECT_EQ(distance_of({-0x1p-239, 0.5, 0}, {0, 0, 1}, triangle), 0.0);
  EXPECT_EQ(distance_of({0.5, 0.5 + 0x1p-53, 0}, {0, 0, 1}, triangle), 0.0);
}

TEST(HitRule, AnOriginOnASurfaceDoesNotHitIt) {
  Numbers numbers(77);
  for (int i = 0; i < 20'000; ++i) {
    const double size = std::pow(10.0, numbers.in(-6.0, 6.0));
    const std::array<Eigen::Vector3f, 3> p = {numbers.in_cube(size).cast<float>(),
                                              numbers.in_cube(size).cast<float>(),
                                              numbers.in_cube(size).cast<float>()};
    const Eigen::Vector3d edge = p[1].cast<double>() - p[0].cast<double>();
    const Eigen::Vector3d other = p[2].cast<double>() - p[0].cast<double>();
    if (edge.cross(other).norm() < 0.05 * size * size) continue;  // a sliver may be seen
    const double weight = numbers.in(0.05, 0.45);
    const Eigen::Vector3d origin =
        p[0].cast<double>() + weight * edge + numbers.in(0.05, 0.45) * other;
    // from steep to almost in the triangle's plane
    const double steepness = std::pow(10.0, -2.0 * (i % 5));
    const Eigen::Vector3d direction =
        (edge.normalized() + steepness * numbers.direction()).normalized();
    const auto corner = [&](std::size_t k) {
      return std::array<float, 3>{p[k].x(), p[k].y(), p[k].z()};
    };
    EXPECT_EQ(distance_of(origin, direction, {corner(0), corner(1), corner(2)}), 0.0) << i;
  }
}

TEST(HitRule, NothingBehindOrAtTheOriginIsHit) {
  const HitTriangle triangle = unit_triangle();
  EXPECT_EQ(distance_of({0.25, 0.25, 2}, {0, 0, 1}, triangle), 0.0);
  EXPECT_EQ(distance_of({0.25, 0.25, 2.5}, {0, 0, 1}, triangle), 0.0);
  EXPECT_EQ(distance_of({0, 0, 2}, {0.1, 0.1, 1}, triangle), 0.0) << "sensor on a vertex";
}

TEST(HitRule, TrianglesSeenEdgeOnOrWithoutAreaAreNotHit) {
  EXPECT_EQ(distance_of({0.5, -1, 2}, {0, 1, 0}, unit_triangle()), 0.0);
  const HitTriangle line{{0, 0, 1}, {1, 1, 2}, {2, 2, 3}};
  EXPECT_EQ(distance_of({1, 1, 0}, {0, 0, 1}, line), 0.0);
  const HitTriangle point{{1, 1, 2}, {1, 1, 2}, {1, 1, 2}};
  EXPECT_EQ(distance_of({1, 1, 0}, {0, 0, 1}, point), 0.0);
}

TEST(HitRule, SignsOfZerosDoNotMatter) {
  for (const float zero : {0.0F, -0.0F}) {
    const HitTriangle triangle{{zero, zero, 2}, {1, zero, 2}, {zero, 1, 2}};
    for (const double other : {0.0, -0.0}) {
      EXPECT_EQ(distance_of({other, 0.5, other}, {other, -other, 1}, triangle), 2.0);
      EXPECT_EQ(distance_of({other, other, other}, {-other, other, 1}, triangle), 2.0);
    }
  }
}

TEST(HitRule, OrderAndWindingOfCornersDoNotMatter) {
  Numbers numbers(1);
  std::size_t hits = 0;
  for (int i = 0; i < 200000; ++i) {
    const bool is_lattice = i % 2 == 0;
    HitTriangle t = lattice_triangle(numbers);
    TestRay ray = lattice_ray(numbers);
    if (!is_lattice) {
      for (auto* corner : {&t.a, &t.b, &t.c}) {
        for (float& x : *corner) x = static_cast<float>(numbers.in(-1.0, 1.0));
      }
      ray = aimed(numbers.in_cube(3.0), numbers.in_cube(0.3));
    }
    const HitRay prepared = make_hit_ray(ray.origin, ray.direction);
    const double expected = hit_distance(prepared, t);
    hits += static_cast<std::size_t>(expected > 0.0);
    for (const HitTriangle& other :
         {HitTriangle{t.b, t.c, t.a}, HitTriangle{t.c, t.a, t.b}, HitTriangle{t.b, t.a, t.c},
          HitTriangle{t.a, t.c, t.b}, HitTriangle{t.c, t.b, t.a}}) {
      ASSERT_EQ(hit_distance(prepared, other), expected) << i;
    }
  }
  EXPECT_GT(hits, 10000U);
}

TEST(HitRule, TrianglesAtAVertexAreHitAtTheSameDistance) {
  Numbers numbers(2);
  for (int i = 0; i < 2000; ++i) {
    const TestMesh fan = make_fan(7, numbers.in_cube(1.0), 0.5, numbers);
    const Eigen::Vector3d centre = fan.vertices[0].cast<double>();
    const HitRay ray = make_hit_ray({centre.x(), centre.y(), -3.0}, {0, 0, 1});
    for (std::size_t t = 0; t < fan.triangles.size(); ++t) {
      ASSERT_EQ(hit_distance(ray, fan.triangle(t)), centre.z() + 3.0);
    }
  }
}

TEST(HitRule, TrianglesAtAnEdgeAreHitAtTheSameDistance) {
  Numbers numbers(3);
  for (int i = 0; i < 20000; ++i) {  // the edge crosses the beam, a multiple of it on either side
    const double x = numbers.in(0.1, 1.0);
    const double y = numbers.in(0.1, 1.0);
    const auto wide = static_cast<float>(1U << numbers.below(4));
    const std::array<float, 3> p{static_cast<float>(x), static_cast<float>(y), 3.0F};
    const std::array<float, 3> q{-wide * p[0], -wide * p[1],
                                 static_cast<float>(numbers.in(2.0, 4.0))};
    const HitRay ray = make_hit_ray({0, 0, 0}, {0, 0, 1});
    const double left = hit_distance(ray, {p, q, {-3, static_cast<float>(numbers.in(2, 5)), 4}});
    const double right = hit_distance(ray, {p, {3, static_cast<float>(numbers.in(-5, -2)), 1}, q});
    ASSERT_GT(left, 0.0);
    ASSERT_EQ(left, right);
  }
}

TEST(HitRule, ClosedFansDoNotLeakAtTheirVertices) {
  Numbers numbers(4);
  for (int i = 0; i < 20000; ++i) {
    const double size = std::abs(numbers.of_any_size(-60, 20));
    const double away = std::abs(numbers.of_any_size(-10, 40));
    const TestMesh fan =
        make_fan(3 + numbers.below(9), size * numbers.in_cube(100.0), size, numbers);
    const Eigen::Vector3d vertex = fan.vertices[0].cast<double>();
    const Eigen::Vector3d origin =
        vertex + away * size * Eigen::Vector3d(numbers.in(-0.3, 0.3), numbers.in(-0.3, 0.3), -1.0);
    // a sensor beyond 2^52 sizes cannot resolve the fan
    if (away > 0x1p38) continue;
    ASSERT_NE(nearest_of_all(fan, aimed(origin, vertex)).primitive, UINT32_MAX)
        << "size " << size << ", " << away << " sizes away";
  }
}

TEST(HitRule, ClosedMeshesDoNotLeakAtVerticesAndEdges) {
  Numbers numbers(5);
  for (const double radius : {1.0, 1e-12, 6.371e6, 1e25}) {
    for (const double offset : {0.0, 5.0}) {
      const Eigen::Vector3d centre = offset * radius * numbers.direction();
      const TestMesh sphere = make_sphere(2, radius, centre);
      for (int i = 0; i < 1500; ++i) {
        const Eigen::Vector3d origin = centre + numbers.in_cube(0.4 * radius);
        const TestRay ray = aimed(origin, sphere.corner_or_edge(numbers));
        ASSERT_NE(nearest_of_all(sphere, ray).primitive, UINT32_MAX)
            << "radius " << radius << ", offset " << offset << ", ray " << i;
      }
    }
  }
}

TEST(HitRule, ASensorOnAVertexSeesTheOtherSideAndNotTheVertex) {
  Numbers numbers(6);
  const TestMesh sphere = make_sphere(2, 1.0, Eigen::Vector3d::Zero());
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d vertex =
        sphere.vertices[numbers.below(sphere.vertices.size())].cast<double>();
    const TestRay ray{vertex, numbers.direction()};
    const double inwards = -ray.direction.dot(vertex);
    if (std::abs(inwards) < 0.2) continue;  // along the faces around it
    const HitCandidate hit = nearest_of_all(sphere, ray);
    ASSERT_EQ(hit.primitive != UINT32_MAX, inwards > 0.0);
    if (inwards > 0.0) {
      ASSERT_NEAR(hit.distance, 2.0 * inwards, 0.1);
    }
  }
}

TEST(HitRule, EqualDistancesAreOrderedByInstanceThenTriangle) {
  EXPECT_TRUE(is_nearer({1.0, 5, 5}, {2.0, 0, 0}));
  EXPECT_TRUE(is_nearer({1.0, 1, 9}, {1.0, 2, 0}));
  EXPECT_TRUE(is_nearer({1.0, 1, 3}, {1.0, 1, 4}));
  EXPECT_FALSE(is_nearer({1.0, 1, 4}, {1.0, 1, 4}));
}

TEST(HitRule, OffsetsOfABillionMetresAreExactInDouble) {
  // two parallel plates a millimetre apart, seen from 1e9 m: double resolves 1.2e-7 m there
  const HitTriangle front{{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}};
  const HitTriangle back{{-1, -1, 0.001F}, {3, -1, 0.001F}, {-1, 3, 0.001F}};
  const Eigen::Vector3d origin(0.2, 0.3, -1e9);
  EXPECT_EQ(distance_of(origin, {0, 0, 1}, front), 1e9);
  EXPECT_NEAR(distance_of(origin, {0, 0, 1}, back) - 1e9, 0.001, 2.4e-7);
}

TEST(HitLimits, RaysOutsideThemHitNothingAndAreNamed) {
  const HitTriangle large{{-3e38F, -3e38F, 2}, {3e38F, -3e38F, 2}, {0, 3e38F, 2}};
  const Eigen::Vector3d ahead(0, 0, 1);
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  EXPECT_GT(distance_of({0, 0, -kMaxHitOrigin}, ahead, large), 0.0);
  EXPECT_GT(distance_of(zero, kMinHitDirection * ahead, large), 0.0);
  EXPECT_GT(distance_of(zero, kMaxHitDirection * ahead, large), 0.0);
  const double nan = kNaN;
  const std::vector<TestRay> outside = {{{0, 0, -1.01 * kMaxHitOrigin}, ahead},
                                        {{nan, 0, 0}, ahead},
                                        {{0, 0, -kInfinity}, ahead},
                                        {zero, {0, 0, 0}},
                                        {zero, {0, nan, 1}},
                                        {zero, {0, 0, kInfinity}},
                                        {zero, 0.9 * kMinHitDirection * ahead},
                                        {zero, 1.1 * kMaxHitDirection * ahead}};
  for (const TestRay& ray : outside) {
    EXPECT_FALSE(is_within_hit_limits(ray.origin, ray.direction));
    EXPECT_EQ(distance_of(ray.origin, ray.direction, large), 0.0);
    EXPECT_NE(error_text([&] { check_hit_limits("beam 3", ray.origin, ray.direction); }),
              "no error");
  }
  EXPECT_EQ(error_text([&] { check_hit_limits("beam 3", zero, ahead); }), "no error");
  EXPECT_EQ(error_text([&] {
              check_hit_limits("beam 3", {0, 0, 1e80}, ahead);
            }),
            "beam 3: its origin is (0, 0, 1e+80) in the frame of a mesh; allowed: finite "
            "coordinates up to "
            "1.7668470647783843e+72; place the sensor and the objects nearer to each other");
  EXPECT_EQ(error_text([&] { check_hit_limits("beam 3", zero, zero); }),
            "beam 3: its direction is (0, 0, 0) in the frame of a mesh; allowed: finite numbers, "
            "the largest from "
            "5.421010862427522e-20 to 18446744073709551616; make the direction a unit vector");
}

TEST(ExactProduct, DekkersProductEqualsAFusedMultiplyAdd) {
  Numbers numbers(7);
  for (int i = 0; i < 1000000; ++i) {
    const double a = numbers.of_any_size(-240, 242);
    double b = numbers.of_any_size(-240, 242);
    if (i % 4 == 1) b = static_cast<float>(b);
    if (i % 4 == 2) b = (i & 8) != 0 ? 0.0 : -0.0;
    if (i % 4 == 3) b = std::nextafter(1.0, 2.0);
    const double fused = FusedProduct::error(a, b, a * b);
    const double split = DekkerProduct::error(a, b, a * b);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(fused), std::bit_cast<std::uint64_t>(split))
        << a << " * " << b;
  }
}

TEST(HitRule, HasTheSameBitsWithAndWithoutAFusedMultiplyAdd) {
  Numbers numbers(8);
  std::size_t hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const TestMesh fan = make_fan(5, numbers.in_cube(10.0), 1.0, numbers);
    const Eigen::Vector3d origin = numbers.in_cube(1.0) - 20.0 * Eigen::Vector3d::UnitZ();
    const TestRay aimed_ray = aimed(origin, fan.corner_or_edge(numbers));
    const HitRay ray = make_hit_ray(aimed_ray.origin, aimed_ray.direction);
    for (std::size_t t = 0; t < fan.triangles.size(); ++t) {
      const double fused = hit_arithmetic::distance<FusedProduct>(ray, fan.triangle(t));
      ASSERT_EQ(hit_arithmetic::distance<DekkerProduct>(ray, fan.triangle(t)), fused);
      ASSERT_EQ(hit_distance(ray, fan.triangle(t)), fused);
      hits += static_cast<std::size_t>(fused > 0.0);
    }
  }
  EXPECT_GT(hits, 20000U);
}

TEST(HitRule, HasTheSameBitsOnEveryProcessorAndCompiler) {
  Numbers numbers(9);
  std::uint64_t hash = 1469598103934665603U;  // FNV-1a, by words
  for (int i = 0; i < 20000; ++i) {
    HitTriangle triangle{};
    for (auto* corner : {&triangle.a, &triangle.b, &triangle.c}) {
      for (float& x : *corner) x = static_cast<float>(numbers.in(-1.0, 1.0));
    }
    const Eigen::Vector3d origin = numbers.in_cube(3.0);
    const Eigen::Vector3d target = numbers.in_cube(0.3);
    const double distance = distance_of(origin, target - origin, triangle);
    hash = (hash ^ std::bit_cast<std::uint64_t>(distance)) * 1099511628211U;
  }
  EXPECT_EQ(hash, 17975248530264896655U);
}

}  // namespace
}  // namespace glidar
