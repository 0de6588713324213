// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/random.hpp>
#include <glidar/verify/shapes.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace glidar {
namespace {

const Shape& shape_named(const std::vector<Shape>& shapes, const std::string& name) {
  for (const Shape& shape : shapes) {
    if (shape.name == name) return shape;
  }
  throw std::logic_error("no shape " + name);
}

/// The nearest triangle that the ray meets, by Moeller and Trumbore 1997.
std::optional<double> brute_force(const Mesh& mesh, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction) {
  std::optional<double> nearest;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.positions_m[t[0]].cast<double>();
    const Eigen::Vector3d ab = mesh.positions_m[t[1]].cast<double>() - a;
    const Eigen::Vector3d ac = mesh.positions_m[t[2]].cast<double>() - a;
    const Eigen::Vector3d p = direction.cross(ac);
    const double determinant = ab.dot(p);
    if (determinant == 0.0) continue;
    const Eigen::Vector3d s = origin - a;
    const Eigen::Vector3d q = s.cross(ab);
    const double u = s.dot(p) / determinant;
    const double v = direction.dot(q) / determinant;
    const double range = ac.dot(q) / determinant;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || range <= 0.0) continue;
    if (!nearest || range < *nearest) nearest = range;
  }
  return nearest;
}

TEST(VerifyShapes, FitIntoTheUnitSphere) {
  for (const Shape& shape : make_shapes()) {
    for (const Eigen::Vector3f& p : shape.mesh.positions_m) EXPECT_LE(p.norm(), 1.0F + 1e-6F);
    EXPECT_NO_THROW(validate(shape.mesh)) << shape.name;
  }
}

TEST(VerifyShapes, SolidsAreConvexClosedAndFaceOutwards) {
  for (const Shape& shape : make_shapes()) {
    if (!shape.solid) continue;
    const ClosedForm form = make_closed_form(shape, 1.0, Pose::Identity(), {0.0, 0.0, 0.0});
    for (const HalfSpace& side : form.sides) {
      EXPECT_GT(side.offset, 0.0L) << shape.name;
      for (const Eigen::Vector3f& p : shape.mesh.positions_m) {
        EXPECT_LE(side.normal.dot(p.cast<Real>()), side.offset + 1e-15L) << shape.name;
      }
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const Triangle& t : shape.mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    }
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1) << shape.name;
      EXPECT_EQ(edges.count({edge.second, edge.first}), 1U) << shape.name;
    }
  }
}

TEST(VerifyShapes, BoxIsHitAtItsSides) {
  const std::vector<Shape> shapes = make_shapes();
  const ClosedForm form =
      make_closed_form(shape_named(shapes, "box"), 2.0, Pose::Identity(), {-10.0, 0.25, 0.1});
  const ExactHit hit = intersect(form, {0.0L, 0.0L, 0.0L}, {1.0L, 0.0L, 0.0L}, 1e-6L);
  EXPECT_TRUE(hit.hit);
  EXPECT_TRUE(hit.clear);
  EXPECT_EQ(hit.range_m, 9.0L);
  EXPECT_EQ(hit.normal, RealVector(-1.0L, 0.0L, 0.0L));
  EXPECT_FALSE(intersect(form, {0.0L, 0.0L, 0.0L}, {-1.0L, 0.0L, 0.0L}, 1e-6L).hit);
}

TEST(VerifyShapes, RaysNearEdgesAreNotCompared) {
  const std::vector<Shape> shapes = make_shapes();
  const ClosedForm form =
      make_closed_form(shape_named(shapes, "box"), 1.0, Pose::Identity(), {-10.0, 0.0, 0.0});
  const RealVector ahead(1.0L, 0.0L, 0.0L);
  for (const Real beside : {-2e-6L, -0.5e-6L, 0.5e-6L, 2e-6L}) {
    const ExactHit result = intersect(form, {0.0L, 0.625L + beside, 0.0L}, ahead, 1e-6L);
    EXPECT_EQ(result.hit, beside < 0.0L);
    EXPECT_EQ(result.clear, std::abs(beside) > 1e-6L) << static_cast<double>(beside);
  }
}

TEST(VerifyShapes, PlaneIsTwoSidedAndEndsAtItsEdges) {
  const std::vector<Shape> shapes = make_shapes();
  const ClosedForm form =
      make_closed_form(shape_named(shapes, "tilted plane"), 1.0, Pose::Identity(), {0.0, 0.0, 5.0});
  const RealVector down(0.0L, 0.0L, -1.0L);
  const ExactHit front = intersect(form, {0.0L, 0.0L, 0.0L}, down, 1e-6L);
  EXPECT_TRUE(front.hit);
  EXPECT_EQ(front.range_m, 5.0L);
  EXPECT_EQ(front.normal, RealVector(0.0L, 0.0L, 1.0L));
  const ExactHit back = intersect(form, {0.0L, 0.0L, -10.0L}, -down, 1e-6L);
  EXPECT_TRUE(back.hit);
  EXPECT_EQ(back.normal, RealVector(0.0L, 0.0L, -1.0L));
  EXPECT_FALSE(intersect(form, {0.76L, 0.0L, 0.0L}, down, 1e-6L).hit);
  EXPECT_FALSE(intersect(form, {0.75L, 0.0L, 0.0L}, down, 1e-6L).clear);
  EXPECT_FALSE(intersect(form, {0.0L, 0.0L, -5.0L}, RealVector(1.0L, 0.0L, 0.0L), 1e-6L).clear);
}

TEST(VerifyShapes, AgreeWithBruteForceOverTheirTriangles) {
  const Eigen::Vector3d viewpoint(0.5, -2.5, 1.5);
  for (const Shape& shape : make_shapes()) {
    const ClosedForm form = make_closed_form(shape, 1.0, Pose::Identity(), viewpoint);
    int hits = 0;
    int misses = 0;
    for (std::uint32_t i = 0; i < 3000; ++i) {
      const RandomWords words = random_words({.seed = 7, .beam = i});
      const Eigen::Vector3d aim =
          2.0 * Eigen::Vector3d(uniform(words[0]), uniform(words[1]), uniform(words[2])) -
          Eigen::Vector3d::Ones();
      const Eigen::Vector3d direction = (aim - viewpoint).normalized();
      const ExactHit truth = intersect(form, RealVector::Zero(), direction.cast<Real>(), 1e-9L);
      if (!truth.clear) continue;
      const std::optional<double> range = brute_force(shape.mesh, viewpoint, direction);
      ASSERT_EQ(truth.hit, range.has_value()) << shape.name << " ray " << i;
      ++(truth.hit ? hits : misses);
      if (!truth.hit) continue;
      ASSERT_NEAR(static_cast<double>(truth.range_m), *range, 1e-11) << shape.name;
    }
    EXPECT_GT(hits, 300) << shape.name;
    EXPECT_GT(misses, 100) << shape.name;
  }
}

TEST(VerifyShapes, RaysFromInsideAndFromAVertexLeaveThroughTheCorrectSide) {
  const std::vector<Shape> shapes = make_shapes();
  const Shape& box = shape_named(shapes, "box");
  const ClosedForm inside = make_closed_form(box, 2.0, Pose::Identity(), {0.25, 0.0, 0.0});
  const ExactHit hit =
      intersect_from_inside(inside, RealVector::Zero(), {1.0L, 0.0L, 0.0L}, 1e-12L);
  EXPECT_TRUE(hit.hit && hit.clear);
  EXPECT_EQ(hit.range_m, 0.75L);
  EXPECT_EQ(hit.normal, RealVector(-1.0L, 0.0L, 0.0L));
  const ClosedForm corner = make_closed_form(box, 2.0, Pose::Identity(), {1.0, 1.25, 0.75});
  const ExactHit out =
      intersect_from_inside(corner, RealVector::Zero(), {0.6L, 0.8L, 0.0L}, 1e-12L);
  EXPECT_FALSE(out.hit);
  EXPECT_TRUE(out.clear);
  const ExactHit through =
      intersect_from_inside(corner, RealVector::Zero(), {-1.0L, 0.0L, 0.0L}, 1e-12L);
  EXPECT_FALSE(through.clear);  // along two sides
  const RealVector across = RealVector(-2.0L, -2.5L, -1.5L).normalized();
  const ExactHit far = intersect_from_inside(corner, RealVector::Zero(),
                                             RealVector(-0.6L, -0.6L, -0.52L).normalized(), 1e-12L);
  EXPECT_TRUE(far.hit && far.clear);
  EXPECT_FALSE(intersect_from_inside(corner, RealVector::Zero(), across, 1e-12L)
                   .clear);  // to the far corner
}

}  // namespace
}  // namespace glidar
