// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/raster/tile_buffer.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

namespace glidar::raster {
namespace {

/// A square with edges along rows and columns and constant nearness.
TriangleSetup square(const PixelBounds& rect, float nearness, std::uint32_t triangle_id) {
  TriangleSetup setup{};
  setup.rect = rect;
  setup.per_col = {1.0F, -1.0F, 0.0F};
  setup.per_row = {0.0F, 0.0F, 1.0F};
  setup.at_corner = {0.0F, static_cast<float>(rect.right - rect.left), 0.0F};
  setup.certain = {0.5F, 0.5F, 0.5F};
  setup.nearness_at_corner = nearness;
  setup.farthest = 0.0F;
  setup.nearest = 1.0F;
  setup.triangle_id = triangle_id;
  return setup;
}

std::vector<std::uint32_t> drawn_numbers(const TileBuffer& tile) {
  std::vector<std::uint32_t> triangle_ids;
  tile.copy_triangle_ids(triangle_ids);
  return triangle_ids;
}

/// The ids without flags.
std::vector<std::uint32_t> triangles_of(const TileBuffer& tile) {
  std::vector<std::uint32_t> triangle_ids = drawn_numbers(tile);
  for (std::uint32_t& triangle_id : triangle_ids) triangle_id &= kTriangleIdMask | kCertainFlag;
  return triangle_ids;
}

std::unique_ptr<TileBuffer> empty_canvas(int cols, int rows) {
  auto tile = std::make_unique<TileBuffer>();
  tile->clear(cols, rows, 1.0F);
  return tile;
}

/// Random setups, sloping and overlapping.
std::vector<TriangleSetup> many_shapes(int cols, int rows) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> tile(0.0F, 1.0F);
  std::vector<TriangleSetup> shapes;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const int left = static_cast<int>(tile(random) * static_cast<float>(cols - 1));
    const int top = static_cast<int>(tile(random) * static_cast<float>(rows - 1));
    const PixelBounds rect{left, std::min(cols - 1, left + 9), top, std::min(rows - 1, top + 6)};
    // Few different values, so that some triangles are equally near.
    TriangleSetup setup = square(rect, 0.25F * std::floor(4.0F * tile(random)), i);
    if (i % 2 == 0) setup.nearness_per_col = 0.01F * tile(random);
    shapes.push_back(setup);
  }
  return shapes;
}

TEST(RasterTileBuffer, IsEmptyAfterClear) {
  const auto tile = empty_canvas(10, 6);
  EXPECT_EQ(drawn_numbers(*tile), std::vector<std::uint32_t>(60, kNoTriangleId));
  tile->depth_test(3, 2, 0.5F, 0.0F, 7);
  EXPECT_EQ(drawn_numbers(*tile)[2 * 10 + 3], 7U);
  tile->clear(9, 5, 1.0F);
  EXPECT_EQ(drawn_numbers(*tile), std::vector<std::uint32_t>(45, kNoTriangleId));
}

TEST(RasterTileBuffer, TheNearestTriangleWinsInAnyOrder) {
  const int cols = 61;
  const int rows = 47;
  std::vector<TriangleSetup> shapes = many_shapes(cols, rows);
  const auto forward = empty_canvas(cols, rows);
  for (const TriangleSetup& setup : shapes) forward->draw(setup);
  std::shuffle(shapes.begin(), shapes.end(), std::mt19937(5));
  const auto shuffled = empty_canvas(cols, rows);
  for (const TriangleSetup& setup : shapes) shuffled->draw(setup);
  EXPECT_EQ(triangles_of(*forward), triangles_of(*shuffled));
}

TEST(RasterTileBuffer, TheLowerIdWinsAtEqualNearness) {
  const auto tile = empty_canvas(8, 8);
  tile->draw(square({0, 7, 0, 7}, 0.5F, 5));
  tile->draw(square({0, 7, 0, 7}, 0.5F, 3));
  tile->draw(square({0, 7, 0, 7}, 0.5F, 4));
  tile->depth_test(1, 1, 0.5F, 0.0F, 9 | kCertainFlag);
  tile->depth_test(2, 1, 0.5F, 0.0F, 1 | kCertainFlag);
  const std::vector<std::uint32_t> triangle_ids = drawn_numbers(*tile);
  EXPECT_EQ(triangle_ids[8 + 1], 3U | kCertainFlag | kContestedFlag);
  EXPECT_EQ(triangle_ids[8 + 2], 1U | kCertainFlag | kContestedFlag);
}

TEST(RasterTileBuffer, MarksSurfacesThatAreTooCloseInEitherOrder) {
  const TriangleSetup near = square({0, 7, 0, 7}, 0.5F, 5);
  for (const float apart : {0x1p-24F, 0x1p-20F, -0x1p-24F, -0x1p-20F}) {
    const TriangleSetup far = square({0, 7, 0, 7}, 0.5F - apart, 3);
    for (const bool is_swapped : {false, true}) {
      const auto tile = empty_canvas(8, 8);
      tile->draw(is_swapped ? far : near);
      tile->draw(is_swapped ? near : far);
      const std::uint32_t triangle_id = drawn_numbers(*tile)[3 * 8 + 3];
      EXPECT_EQ(triangle_id, (apart > 0.0F ? 5U : 3U) | kCertainFlag | kContestedFlag) << apart;
    }
  }
}

TEST(RasterTileBuffer, DoesNotMarkSurfacesThatAreClearlyApart) {
  const auto tile = empty_canvas(8, 8);
  tile->draw(square({0, 7, 0, 7}, 0.5F, 5));
  tile->draw(square({0, 7, 0, 7}, 0.5F - 0x1p-16F, 3));
  tile->depth_test(1, 1, 0.5F - 0x1p-16F, 0.0F, 4);
  EXPECT_EQ(drawn_numbers(*tile)[3 * 8 + 3], 5U | kCertainFlag);
  EXPECT_EQ(drawn_numbers(*tile)[8 + 1], 5U | kCertainFlag);
}

TEST(RasterTileBuffer, MarksSurfacesWithRoughNearness) {
  TriangleSetup rough = square({0, 7, 0, 7}, 0.5F, 5);
  rough.margin = 0.01F;
  const auto tile = empty_canvas(8, 8);
  tile->draw(rough);
  tile->draw(square({0, 7, 0, 7}, 0.6F, 3));
  EXPECT_EQ(drawn_numbers(*tile)[3 * 8 + 3], 3U | kCertainFlag | kContestedFlag);
}

TEST(RasterTileBuffer, MarksPixelsFarFromEdgesAsCertain) {
  const auto tile = empty_canvas(8, 8);
  tile->draw(square({1, 6, 1, 6}, 0.5F, 2));
  const std::vector<std::uint32_t> triangle_ids = drawn_numbers(*tile);
  EXPECT_EQ(triangle_ids[3 * 8 + 1], 2U);                 // on the left edge
  EXPECT_EQ(triangle_ids[3 * 8 + 6], 2U);                 // on the right one
  EXPECT_EQ(triangle_ids[3 * 8 + 3], 2U | kCertainFlag);  // in the middle
}

TEST(RasterTileBuffer, OccludesARectangleOnlyIfAllOfItIsNearer) {
  for (const int side : {6, 40}) {  // pixel by pixel, and by cells
    const auto tile = empty_canvas(100, 100);
    const PixelBounds rect{20, 20 + side, 30, 30 + side};
    EXPECT_FALSE(tile->is_occluded(rect, 0.1F));
    tile->draw(square({16, 87, 24, 87}, 0.5F, 1));
    tile->mark_stale({16, 87, 24, 87});
    EXPECT_TRUE(tile->is_occluded(rect, 0.4F)) << side;
    EXPECT_FALSE(tile->is_occluded(rect, 0.5F)) << side;
    EXPECT_FALSE(tile->is_occluded({10, 20 + side, 30, 30 + side}, 0.4F)) << side;
  }
}

TEST(RasterTileBuffer, CellsBeyondTheBorderOccludeToo) {
  const auto tile = empty_canvas(43, 29);
  tile->draw(square({0, 42, 0, 28}, 0.5F, 1));
  tile->mark_stale({0, 42, 0, 28});
  EXPECT_TRUE(tile->is_occluded({30, 42, 15, 28}, 0.4F));
}

}  // namespace
}  // namespace glidar::raster
