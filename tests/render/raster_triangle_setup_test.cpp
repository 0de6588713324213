// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/raster/cluster_drawing.hpp>

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace glidar::raster {
namespace {

constexpr PixelBounds kAll{0, 59, 0, 49};

const Nearness& nearness() {
  static const Nearness between({.near_m = 1.0, .far_m = 20.0});
  return between;
}

/// Distance of a pixel from the edges of a triangle in front of the sensor, pixels; positive
/// inside.
double inside_px(const Eigen::Matrix3d& corners, int col, int row) {
  Eigen::Matrix<double, 2, 3> projections = corners.colwise().hnormalized();
  const Eigen::Vector2d e1 = projections.col(1) - projections.col(0);
  const Eigen::Vector2d e2 = projections.col(2) - projections.col(0);
  if (e1.x() * e2.y() - e1.y() * e2.x() < 0.0) projections.col(1).swap(projections.col(2));
  double smallest = 1e9;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2d edge = projections.col((k + 1) % 3) - projections.col(k);
    const Eigen::Vector2d from = Eigen::Vector2d(col, row) - projections.col(k);
    smallest = std::min(smallest, (edge.x() * from.y() - edge.y() * from.x()) / edge.norm());
  }
  return smallest;
}

/// Nearness where a pixel's beam hits the triangle's plane.
double nearness_at(const Eigen::Matrix3d& corners, int col, int row) {
  const Eigen::Vector3d normal =
      (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
  const double depth = normal.dot(corners.col(0)) / normal.dot(Eigen::Vector3d(col, row, 1.0));
  return nearness().at(depth);
}

/// Sixteen triangles of about one size, in the tile and around it; column k: corner k as (column,
/// row, 1) times depth.
std::array<Eigen::Matrix3d, kLanes> triangles(double size_px, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> tile(-1.0, 1.0);
  std::array<Eigen::Matrix3d, kLanes> all;
  for (Eigen::Matrix3d& corners : all) {
    const Eigen::Vector2d middle(30.0 + 33.0 * tile(random), 25.0 + 28.0 * tile(random));
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d projection =
          middle + size_px * Eigen::Vector2d(tile(random), tile(random));
      corners.col(k) = (8.0 + tile(random)) * projection.homogeneous();
    }
  }
  return all;
}

/// The same for single precision, relative to a middle.
TileTransform tile_transform(const std::array<Eigen::Matrix3d, kLanes>& all, CornerBlock& corners) {
  const Eigen::Vector3d middle(8.0 * 30.0, 8.0 * 25.0, 8.0);
  for (unsigned i = 0; i < kLanes; ++i) {
    corners.c0.set(i, (all[i].col(0) - middle).cast<float>());
    corners.c1.set(i, (all[i].col(1) - middle).cast<float>());
    corners.c2.set(i, (all[i].col(2) - middle).cast<float>());
  }
  return {.matrix = {1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F},
          .column = static_cast<float>(middle.x()),
          .row = static_cast<float>(middle.y()),
          .depth = static_cast<float>(middle.z()),
          .before_far = static_cast<float>(nearness().far_m - middle.z()),
          .factor = static_cast<float>(nearness().factor),
          .min_depth = 1.0F,
          .last_col = static_cast<float>(kAll.right),
          .last_row = static_cast<float>(kAll.bottom),
          .cull_back_faces = false};
}

/// The coverage of a pixel by a setup.
struct PixelCoverage {
  bool coverage;
  bool certain;
  double nearness;
};

PixelCoverage coverage_at(const TriangleSetup& s, int col, int row) {
  const auto across = static_cast<float>(col - s.rect.left);
  const auto down = static_cast<float>(row - s.rect.top);
  PixelCoverage pixel{
      .coverage =
          col >= s.rect.left && col <= s.rect.right && row >= s.rect.top && row <= s.rect.bottom,
      .certain = true,
      .nearness = static_cast<double>(s.nearness_at_corner + s.nearness_per_col * across +
                                      s.nearness_per_row * down)};
  for (std::size_t k = 0; k < 3; ++k) {
    const float edge = s.at_corner[k] + s.per_col[k] * across + s.per_row[k] * down;
    pixel.coverage = pixel.coverage && edge >= 0.0F;
    pixel.certain = pixel.certain && edge >= s.certain[k];
  }
  return pixel;
}

/// Pixels inside are covered, those clearly outside are not, and certain ones are inside.
void expect_correct(const PixelCoverage& pixel, const Eigen::Matrix3d& corners, int col, int row) {
  const double inside = inside_px(corners, col, row);
  // The margin is along the larger of row and column, up to sqrt(2) times as wide; twice for
  // rounding.
  constexpr double kClear_px = 3.0 * static_cast<double>(kEdgeMargin_px);
  if (inside >= 0.0) {
    EXPECT_TRUE(pixel.coverage) << inside;
  }
  if (inside < -kClear_px) {
    EXPECT_FALSE(pixel.coverage) << inside;
  }
  if (!pixel.coverage) return;
  if (pixel.certain) {
    EXPECT_GE(inside, 0.0);
  }
  EXPECT_TRUE(pixel.certain || inside < kClear_px) << inside;
  EXPECT_NEAR(pixel.nearness, nearness_at(corners, col, row), 1e-6);
}

TEST(RasterTriangleSetup, CoversThePixelsWhoseBeamsHitTheTriangles) {
  std::size_t covered_pixels = 0;
  for (const double size_px : {0.4, 1.5, 5.0, 20.0}) {
    for (unsigned seed = 0; seed < 40; ++seed) {
      const auto all = triangles(size_px, seed);
      CornerBlock corners;
      const TileTransform transform = tile_transform(all, corners);
      TriangleSetups setups;
      set_up_triangles(transform, corners, setups);
      Lanes<std::uint32_t> coverage;
      const std::uint32_t pending = coverage_masks(setups, coverage);
      for (unsigned lane = 0; lane < kLanes; ++lane) {
        const auto size = static_cast<SizeClass>(setups.size[lane]);
        ASSERT_NE(size, SizeClass::large);
        const TriangleSetup setup = setups.setup(lane, 0);
        for (int row = 0; row <= kAll.bottom; ++row) {
          for (int col = 0; col <= kAll.right; ++col) {
            PixelCoverage pixel =
                size == SizeClass::none ? PixelCoverage{} : coverage_at(setup, col, row);
            if (size == SizeClass::small) {
              const int bit = (row - setup.rect.top) * kSmall + col - setup.rect.left;
              const bool is_in = pixel.coverage;
              pixel.coverage = is_in && (coverage[lane] >> bit & 1U) != 0;
              pixel.certain = is_in && (coverage[lane] >> (bit + 16) & 1U) != 0;
              EXPECT_EQ(pixel.coverage, is_in);
            }
            expect_correct(pixel, all[lane], col, row);
            if (pixel.coverage) {
              ++covered_pixels;
              EXPECT_NE(pending >> lane & 1U, 0U);
            }
          }
        }
      }
    }
  }
  EXPECT_GT(covered_pixels, 50'000U);
}

TEST(RasterTriangleSetup, DoublePrecisionCoversTheSamePixels) {
  for (const double size_px : {5.0, 20.0, 400.0}) {
    for (const Eigen::Matrix3d& corners : triangles(size_px, 9)) {
      const std::optional<TriangleSetup> setup = set_up_triangle(corners, nearness(), kAll, false);
      for (int row = 0; row <= kAll.bottom; ++row) {
        for (int col = 0; col <= kAll.right; ++col) {
          expect_correct(setup ? coverage_at(*setup, col, row) : PixelCoverage{}, corners, col,
                         row);
        }
      }
    }
  }
}

TEST(RasterTriangleSetup, AcceptsCornersBehindTheSensor) {
  // A floor 1 m below the sensor, from 30 m behind to 40 m ahead: below the horizon all is covered.
  const double focal_px = 30.0;
  const Eigen::Vector2d centre(30.0, 25.0);
  const auto pixel = [&](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(focal_px * p.x() + centre.x() * p.z(),
                           focal_px * p.y() + centre.y() * p.z(), p.z());
  };
  Eigen::Matrix3d corners;
  corners << pixel({-90.0, 1.0, -30.0}), pixel({90.0, 1.0, -30.0}), pixel({0.0, 1.0, 40.0});
  const std::optional<TriangleSetup> setup = set_up_triangle(corners, nearness(), kAll, false);
  ASSERT_TRUE(setup);
  for (int row = 0; row <= kAll.bottom; ++row) {
    for (int col = 0; col <= kAll.right; ++col) {
      const double depth = focal_px / (row - centre.y());  // where the beam meets the floor
      const double x = (col - centre.x()) / focal_px * depth;
      const double half_width = 90.0 * (40.0 - depth) / 70.0;
      const bool hits = depth > 0.0 && std::abs(x) < half_width;
      const PixelCoverage covered = coverage_at(*setup, col, row);
      EXPECT_EQ(covered.coverage, hits) << col << ' ' << row;
      if (hits) {
        EXPECT_NEAR(covered.nearness, nearness().at(depth), 1e-5);
      }
    }
  }
}

TEST(RasterTriangleSetup, CullsBackFacesOnRequest) {
  const auto all = triangles(6.0, 1);
  CornerBlock corners;
  TileTransform transform = tile_transform(all, corners);
  TriangleSetups both;
  TriangleSetups culled;
  set_up_triangles(transform, corners, both);
  transform.cull_back_faces = true;
  set_up_triangles(transform, corners, culled);
  std::size_t dropped = 0;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    const bool is_back = all[lane].determinant() > 0.0;
    const bool was_there = both.size[lane] != static_cast<int>(SizeClass::none);
    EXPECT_EQ(culled.size[lane] != static_cast<int>(SizeClass::none), was_there && !is_back);
    dropped += static_cast<std::size_t>(was_there && is_back);
    if (is_back) {
      EXPECT_FALSE(set_up_triangle(all[lane], nearness(), kAll, true));
    }
  }
  EXPECT_GT(dropped, 2U);
}

TEST(RasterTriangleSetup, UsesDoublePrecisionWhereSingleIsNotSufficient) {
  auto all = triangles(5.0, 2);
  all[0].col(1) *= -1.0;                                     // behind
  all[1].col(2) = 8.0 * Eigen::Vector3d(4000.0, 20.0, 1.0);  // far beside the tile
  all[1].col(0) = 8.0 * Eigen::Vector3d(20.0, 20.0, 1.0);
  all[2].col(0) = 0.5 * Eigen::Vector3d(30.0, 20.0, 1.0);  // nearer than its cluster allows
  CornerBlock corners;
  const TileTransform transform = tile_transform(all, corners);
  TriangleSetups setups;
  set_up_triangles(transform, corners, setups);
  for (unsigned lane = 0; lane < 3; ++lane) {
    EXPECT_EQ(setups.size[lane], static_cast<int>(SizeClass::large)) << lane;
  }
}

}  // namespace
}  // namespace glidar::raster
