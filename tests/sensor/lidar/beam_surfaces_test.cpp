// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/beam_surfaces.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

using Eigen::Vector3d;

/// The intersection of a ray from the origin with a plane through a point.
SubRayHit on_plane(const Vector3d& ray, const Vector3d& point, const Vector3d& normal,
                   std::uint32_t index = 0) {
  const Vector3d direction = ray.normalized();
  const double range_m = normal.dot(point) / normal.dot(direction);
  const Vector3d unit = normal.normalized();
  const Vector3d towards = unit.dot(direction) < 0.0 ? unit : Vector3d(-unit);
  return {range_m * direction, towards, -towards.dot(direction), range_m, index};
}

/// A ray tilted sideways, of a beam along z.
Vector3d ray(double lean) {
  return {lean, 0.0, 1.0};
}

constexpr double kTilt = 1e-3;  // from sub-ray to sub-ray: 10 mm at 10 m

TEST(HasGap, IsFalseWithinAPlaneAtAnyIncidence) {
  for (double tilt = -1.57; tilt < 1.57; tilt += 0.0301) {
    const Vector3d normal(std::sin(tilt), 0.0, std::cos(tilt));
    for (const double range_m : {0.5, 10.0, 200.0}) {
      const SubRayHit a = on_plane(ray(0.0), {0.0, 0.0, range_m}, normal);
      const SubRayHit b = on_plane(ray(kTilt), {0.0, 0.0, range_m}, normal);
      if (!(b.range_m > 0.0)) continue;  // the plane ends in the distance between the two
      EXPECT_FALSE(has_gap(a, b)) << tilt;
      EXPECT_FALSE(has_gap(b, a)) << tilt;
    }
  }
}

// Of parallel planes the tolerance is a quarter of the distance: a gap g at a spacing s with
// g > sqrt(s^2 + g^2) / 4.
TEST(HasGap, IsTrueBetweenParallelPlanesBeyondTheTolerance) {
  const double spacing_m = 10.0 * kTilt;
  const double limit_m = spacing_m / std::sqrt(15.0);
  for (const double part : {0.5, 0.9, 1.1, 2.0, 30.0}) {
    const SubRayHit a = on_plane(ray(0.0), {0.0, 0.0, 10.0}, Vector3d::UnitZ());
    const SubRayHit b = on_plane(ray(kTilt), {0.0, 0.0, 10.0 + part * limit_m}, Vector3d::UnitZ());
    EXPECT_EQ(has_gap(a, b), part > 1.0) << part;
    EXPECT_EQ(has_gap(b, a), part > 1.0) << part;
  }
}

TEST(HasGap, IsFalseAcrossAnEdgeSharedByBothSides) {
  // two planes that meet in x = 0.5 kTilt z at z = 10, a roof or a corner
  const Vector3d edge = 10.0 * ray(0.5 * kTilt);
  for (const double left : {-1.4, -0.7, 0.2, 1.2}) {
    for (const double right : {-1.3, -0.2, 0.6, 1.4}) {
      const SubRayHit a = on_plane(ray(0.0), edge, {std::sin(left), 0.0, std::cos(left)});
      const SubRayHit b = on_plane(ray(kTilt), edge, {std::sin(right), 0.0, std::cos(right)});
      EXPECT_FALSE(has_gap(a, b)) << left << " " << right;
    }
  }
}

TEST(HasGap, IsFalseForTheRoundingOfAdjacentMeshes) {
  const SubRayHit a = on_plane(ray(0.0), {0.0, 0.0, 100.0}, Vector3d::UnitZ());
  const SubRayHit b = on_plane(ray(1e-7), {0.0, 0.0, 100.00005}, Vector3d::UnitZ());
  EXPECT_FALSE(has_gap(a, b));
}

/// The surfaces of points, one a sub-ray.
BeamSurfaces surfaces_of(std::vector<SubRayHit> points) {
  for (std::uint32_t i = 0; i < points.size(); ++i) points[i].ray = i;
  BeamSurfaces surfaces;
  const std::size_t count = points.size() + 1;  // the last one misses
  surfaces.find(std::move(points), count);
  return surfaces;
}

TEST(BeamSurfaces, JoinFacesThroughIntermediateFaces) {
  // stairs from the front: tread, riser, tread; the two treads alone have a gap between them
  const Vector3d up = Vector3d::UnitX();
  const SubRayHit lower = on_plane({-0.05, 0.0, 1.0}, {-0.5, 0.0, 0.0}, up);
  const SubRayHit riser = on_plane({-0.045, 0.0, 1.0}, {0.0, 0.0, 10.5}, Vector3d::UnitZ());
  const SubRayHit upper = on_plane({-0.035, 0.0, 1.0}, {-0.4, 0.0, 0.0}, up);
  ASSERT_LT(lower.range_m, riser.range_m);
  ASSERT_LT(riser.range_m, upper.range_m);
  const BeamSurfaces all = surfaces_of({lower, riser, upper});
  EXPECT_EQ(all.of_ray(0), all.of_ray(1));
  EXPECT_EQ(all.of_ray(1), all.of_ray(2));
  const BeamSurfaces two = surfaces_of({lower, upper});
  EXPECT_NE(two.of_ray(0), two.of_ray(1));
}

TEST(BeamSurfaces, AreOneForASphereAndTwoWithABackground) {
  const double radius_m = 0.5;
  const Vector3d middle(0.0, 0.0, 10.0);
  std::vector<SubRayHit> points;
  for (const double out : {0.0, 0.3, 0.6, 0.9, 0.99, 0.9999}) {
    const Vector3d direction = ray(out * std::tan(std::asin(radius_m / 10.0))).normalized();
    const double along = direction.dot(middle);
    const double range_m = along - std::sqrt(along * along - 100.0 + radius_m * radius_m);
    const Vector3d position = range_m * direction;
    const Vector3d normal = (position - middle) / radius_m;
    points.push_back({position, normal, -normal.dot(direction), range_m, 0});
  }
  const BeamSurfaces ball = surfaces_of(points);
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_EQ(ball.of_ray(i), ball.of_ray(0));
  points.push_back(on_plane(ray(0.053), {0.0, 0.0, 10.3}, Vector3d::UnitZ()));
  const BeamSurfaces both = surfaces_of(points);
  EXPECT_EQ(both.of_ray(5), both.of_ray(0));
  EXPECT_NE(both.of_ray(6), both.of_ray(0));
}

}  // namespace
}  // namespace glidar
