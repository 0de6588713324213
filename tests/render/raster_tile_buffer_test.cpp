// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/raster/tile_buffer.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

namespace glidar::raster {
namespace {

/// A square with borders along rows and columns, everywhere as near.
Shape square(const CanvasRect& rect, float nearness, std::uint32_t number) {
  Shape shape{};
  shape.rect = rect;
  shape.per_col = {1.0F, -1.0F, 0.0F};
  shape.per_row = {0.0F, 0.0F, 1.0F};
  shape.at_corner = {0.0F, static_cast<float>(rect.right - rect.left), 0.0F};
  shape.certain = {0.5F, 0.5F, 0.5F};
  shape.nearness_at_corner = nearness;
  shape.farthest = 0.0F;
  shape.nearest = 1.0F;
  shape.number = number;
  return shape;
}

std::vector<std::uint32_t> drawn_numbers(const Canvas& canvas) {
  std::vector<std::uint32_t> numbers;
  canvas.copy_numbers(numbers);
  return numbers;
}

/// The numbers without what is marked.
std::vector<std::uint32_t> triangles_of(const Canvas& canvas) {
  std::vector<std::uint32_t> numbers = drawn_numbers(canvas);
  for (std::uint32_t& number : numbers) number &= kNumberBits | kCertain;
  return numbers;
}

std::unique_ptr<Canvas> empty_canvas(int cols, int rows) {
  auto canvas = std::make_unique<Canvas>();
  canvas->clear(cols, rows, 1.0F);
  return canvas;
}

/// Shapes at random, sloping and overlapping.
std::vector<Shape> many_shapes(int cols, int rows) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> part(0.0F, 1.0F);
  std::vector<Shape> shapes;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const int left = static_cast<int>(part(random) * static_cast<float>(cols - 1));
    const int top = static_cast<int>(part(random) * static_cast<float>(rows - 1));
    const CanvasRect rect{left, std::min(cols - 1, left + 9), top, std::min(rows - 1, top + 6)};
    // Few different ones, so that some are equally near.
    Shape shape = square(rect, 0.25F * std::floor(4.0F * part(random)), i);
    if (i % 2 == 0) shape.nearness_per_col = 0.01F * part(random);
    shapes.push_back(shape);
  }
  return shapes;
}

TEST(RasterCanvas, IsEmptyAtFirstAndAfterItIsCleared) {
  const auto canvas = empty_canvas(10, 6);
  EXPECT_EQ(drawn_numbers(*canvas), std::vector<std::uint32_t>(60, kNoNumber));
  canvas->offer(3, 2, 0.5F, 0.0F, 7);
  EXPECT_EQ(drawn_numbers(*canvas)[2 * 10 + 3], 7U);
  canvas->clear(9, 5, 1.0F);
  EXPECT_EQ(drawn_numbers(*canvas), std::vector<std::uint32_t>(45, kNoNumber));
}

TEST(RasterCanvas, TheNearestStaysInWhateverOrderItComes) {
  const int cols = 61;
  const int rows = 47;
  std::vector<Shape> shapes = many_shapes(cols, rows);
  const auto forward = empty_canvas(cols, rows);
  for (const Shape& shape : shapes) forward->draw(shape);
  std::shuffle(shapes.begin(), shapes.end(), std::mt19937(5));
  const auto shuffled = empty_canvas(cols, rows);
  for (const Shape& shape : shapes) shuffled->draw(shape);
  EXPECT_EQ(triangles_of(*forward), triangles_of(*shuffled));
}

TEST(RasterCanvas, OfEquallyNearTheLowerNumberStays) {
  const auto canvas = empty_canvas(8, 8);
  canvas->draw(square({0, 7, 0, 7}, 0.5F, 5));
  canvas->draw(square({0, 7, 0, 7}, 0.5F, 3));
  canvas->draw(square({0, 7, 0, 7}, 0.5F, 4));
  canvas->offer(1, 1, 0.5F, 0.0F, 9 | kCertain);
  canvas->offer(2, 1, 0.5F, 0.0F, 1 | kCertain);
  const std::vector<std::uint32_t> numbers = drawn_numbers(*canvas);
  EXPECT_EQ(numbers[8 + 1], 3U | kCertain | kContested);
  EXPECT_EQ(numbers[8 + 2], 1U | kCertain | kContested);
}

TEST(RasterCanvas, MarksSurfacesTooCloseToTellInEitherOrder) {
  const Shape near = square({0, 7, 0, 7}, 0.5F, 5);
  for (const float apart : {0x1p-24F, 0x1p-20F, -0x1p-24F, -0x1p-20F}) {
    const Shape far = square({0, 7, 0, 7}, 0.5F - apart, 3);
    for (const bool is_swapped : {false, true}) {
      const auto canvas = empty_canvas(8, 8);
      canvas->draw(is_swapped ? far : near);
      canvas->draw(is_swapped ? near : far);
      const std::uint32_t number = drawn_numbers(*canvas)[3 * 8 + 3];
      EXPECT_EQ(number, (apart > 0.0F ? 5U : 3U) | kCertain | kContested) << apart;
    }
  }
}

TEST(RasterCanvas, MarksNoneOfSurfacesThatAreClearlyApart) {
  const auto canvas = empty_canvas(8, 8);
  canvas->draw(square({0, 7, 0, 7}, 0.5F, 5));
  canvas->draw(square({0, 7, 0, 7}, 0.5F - 0x1p-16F, 3));
  canvas->offer(1, 1, 0.5F - 0x1p-16F, 0.0F, 4);
  EXPECT_EQ(drawn_numbers(*canvas)[3 * 8 + 3], 5U | kCertain);
  EXPECT_EQ(drawn_numbers(*canvas)[8 + 1], 5U | kCertain);
}

TEST(RasterCanvas, MarksASurfaceWhoseNearnessIsRough) {
  Shape rough = square({0, 7, 0, 7}, 0.5F, 5);
  rough.room = 0.01F;
  const auto canvas = empty_canvas(8, 8);
  canvas->draw(rough);
  canvas->draw(square({0, 7, 0, 7}, 0.6F, 3));
  EXPECT_EQ(drawn_numbers(*canvas)[3 * 8 + 3], 3U | kCertain | kContested);
}

TEST(RasterCanvas, TellsWhatIsCertainByTheDistanceFromBorders) {
  const auto canvas = empty_canvas(8, 8);
  canvas->draw(square({1, 6, 1, 6}, 0.5F, 2));
  const std::vector<std::uint32_t> numbers = drawn_numbers(*canvas);
  EXPECT_EQ(numbers[3 * 8 + 1], 2U);             // on the left border
  EXPECT_EQ(numbers[3 * 8 + 6], 2U);             // on the right one
  EXPECT_EQ(numbers[3 * 8 + 3], 2U | kCertain);  // in the middle
}

TEST(RasterCanvas, HidesOnlyWhereAllOfARectangleIsNearer) {
  for (const int side : {6, 40}) {  // pixel by pixel, and by cells
    const auto canvas = empty_canvas(100, 100);
    const CanvasRect rect{20, 20 + side, 30, 30 + side};
    EXPECT_FALSE(canvas->hides(rect, 0.1F));
    canvas->draw(square({16, 87, 24, 87}, 0.5F, 1));
    canvas->mark_drawn({16, 87, 24, 87});
    EXPECT_TRUE(canvas->hides(rect, 0.4F)) << side;
    EXPECT_FALSE(canvas->hides(rect, 0.5F)) << side;
    EXPECT_FALSE(canvas->hides({10, 20 + side, 30, 30 + side}, 0.4F)) << side;
  }
}

TEST(RasterCanvas, CellsThatHangOverItsBorderHideToo) {
  const auto canvas = empty_canvas(43, 29);
  canvas->draw(square({0, 42, 0, 28}, 0.5F, 1));
  canvas->mark_drawn({0, 42, 0, 28});
  EXPECT_TRUE(canvas->hides({30, 42, 15, 28}, 0.4F));
}

}  // namespace
}  // namespace glidar::raster
