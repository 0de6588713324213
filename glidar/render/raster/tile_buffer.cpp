// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/raster/tile_buffer.hpp>

#include <glidar/math/simd.hpp>

#include <algorithm>
#include <limits>

namespace glidar::raster {
namespace {

constexpr float kNothing = -1.0F;  // less near than all there is
constexpr int kStroke = 4;         // pixels of a row that lie together
constexpr float kOutside = std::numeric_limits<float>::infinity();

/// Borders and nearness of a shape at the 16 pixels of a block, from those at its first pixel.
struct BlockSteps {
  Lanes<float> border_0;
  Lanes<float> border_1;
  Lanes<float> border_2;
  Lanes<float> nearness;
};

[[gnu::always_inline]] inline void find_steps(const Shape& s, BlockSteps& steps) {
  constexpr unsigned kSide = 4;
  for (unsigned i = 0; i < kLanes; ++i) {
    const unsigned down = i / kSide;
    const auto col = static_cast<float>(i % kSide);
    const auto row = static_cast<float>(down);
    steps.border_0[i] = s.per_col[0] * col + s.per_row[0] * row;
    steps.border_1[i] = s.per_col[1] * col + s.per_row[1] * row;
    steps.border_2[i] = s.per_col[2] * col + s.per_row[2] * row;
    steps.nearness[i] = s.nearness_per_col * col + s.nearness_per_row * row;
  }
}

/// What a border can gain within a block, from its first pixel.
[[gnu::always_inline]] inline float gain(const Shape& s, std::size_t border) {
  constexpr float kDepthSteps = 3.0F;
  const float across = s.per_col[border] > 0.0F ? s.per_col[border] : 0.0F;
  const float down = s.per_row[border] > 0.0F ? s.per_row[border] : 0.0F;
  return kDepthSteps * (across + down);
}

/// The pixels of a block: where it is, and a shape's values at its first pixel.
struct Block {
  float* nearness;
  std::uint32_t* numbers;
  std::array<float, 3> border;
  float shape_nearness;
};

[[gnu::always_inline]] inline void draw_block(const Shape& s, float scale, const BlockSteps& steps,
                                              const Block& block) {
  float* const nearness = block.nearness;
  std::uint32_t* const numbers = block.numbers;
  for (unsigned i = 0; i < kLanes; ++i) {
    const float b0 = block.border[0] + steps.border_0[i];
    const float b1 = block.border[1] + steps.border_1[i];
    const float b2 = block.border[2] + steps.border_2[i];
    const float free = block.shape_nearness + steps.nearness[i];
    const float low = free < s.farthest ? s.farthest : free;
    const float held = low > s.nearest ? s.nearest : low;
    const float before = nearness[i];
    const std::uint32_t number = numbers[i];
    const int inside =
        static_cast<int>(b0 >= 0.0F) & static_cast<int>(b1 >= 0.0F) & static_cast<int>(b2 >= 0.0F);
    const float close = closeness(held, scale, s.room);
    const int nearer =
        static_cast<int>(held > before) |
        (static_cast<int>(held == before) & static_cast<int>(s.number < (number & kNumberBits)));
    const int rough = static_cast<int>(is_rough(held, scale, s.room)) & nearer;
    const int is_close =
        static_cast<int>(held >= before - close) & static_cast<int>(held <= before + close);
    const int contested = inside & (is_close | rough);
    const int certain = static_cast<int>(b0 >= s.certain[0]) &
                        static_cast<int>(b1 >= s.certain[1]) & static_cast<int>(b2 >= s.certain[2]);
    const bool draws = (inside & nearer) != 0;
    nearness[i] = draws ? held : before;
    const std::uint32_t drawn = s.number | static_cast<std::uint32_t>(certain) << 31U;
    numbers[i] = (draws ? drawn | (number & kContested) : number) |
                 static_cast<std::uint32_t>(contested) << 30U;
  }
}

/// A shape's values at a block's first pixel; false where it covers none of the block.
[[gnu::always_inline]] inline bool start_block(const Shape& s, const std::array<float, 3>& gains,
                                               int col, int row, Block& block) {
  const auto across = static_cast<float>(col - s.rect.left);
  const auto down = static_cast<float>(row - s.rect.top);
  for (std::size_t k = 0; k < 3; ++k) {
    block.border[k] = s.at_corner[k] + s.per_col[k] * across + s.per_row[k] * down;
    if (block.border[k] + gains[k] < 0.0F) return false;
  }
  block.shape_nearness =
      s.nearness_at_corner + s.nearness_per_col * across + s.nearness_per_row * down;
  return true;
}

GLIDAR_SIMD void draw_blocks(const Shape& s, float scale, std::size_t blocks_in_row,
                             float* nearness, std::uint32_t* numbers) {
  constexpr int kSide = 4;
  BlockSteps steps;
  find_steps(s, steps);
  const std::array<float, 3> gains = {gain(s, 0), gain(s, 1), gain(s, 2)};
  for (int row = s.rect.top / kSide * kSide; row <= s.rect.bottom; row += kSide) {
    const std::size_t first = static_cast<std::size_t>(row / kSide) * blocks_in_row;
    for (int col = s.rect.left / kSide * kSide; col <= s.rect.right; col += kSide) {
      Block block{};
      if (!start_block(s, gains, col, row, block)) continue;
      const std::size_t place = (first + static_cast<std::size_t>(col / kSide)) * kLanes;
      block.nearness = nearness + place;
      block.numbers = numbers + place;
      draw_block(s, scale, steps, block);
    }
  }
}

/// The least of a block's 16.
[[gnu::always_inline]] inline float least_of(const float* values) {
  float least = values[0];
  for (unsigned i = 1; i < kLanes; ++i) least = values[i] < least ? values[i] : least;
  return least;
}

}  // namespace

void Canvas::clear(int cols, int rows, float scale) {
  cols_ = cols;
  rows_ = rows;
  scale_ = scale;
  const std::size_t used = static_cast<std::size_t>((rows + kCell - 1) / kCell) * kCell * kSide;
  // The cells' pixels outside hide nothing and are not drawn.
  const bool is_whole = cols == kSide && rows % kCell == 0;
  std::fill_n(nearness_.begin(), used, is_whole ? kNothing : kOutside);
  std::fill_n(numbers_.begin(), used, kNoNumber);
  for (int row = 0; !is_whole && row < rows; ++row) {
    for (int col = 0; col < cols; col += kStroke) {
      std::fill_n(&nearness_[place(col, row)], std::min(kStroke, cols - col), kNothing);
    }
  }
  least_.fill(kNothing);
  is_old_.fill(false);
}

float Canvas::least_near(int cell_col, int cell_row) const {
  const float* first = &nearness_[place(cell_col * kCell, cell_row * kCell)];
  const float* below = &nearness_[place(cell_col * kCell, cell_row * kCell + kCell / 2)];
  return std::min(
      {least_of(first), least_of(first + kLanes), least_of(below), least_of(below + kLanes)});
}

float Canvas::least_in(int cell_col, int cell_row) {
  const std::size_t cell = cell_at(cell_col, cell_row);
  if (is_old_[cell]) {
    least_[cell] = least_near(cell_col, cell_row);
    is_old_[cell] = false;
  }
  return least_[cell];
}

bool Canvas::hides(const CanvasRect& rect, float at_most) {
  const float nearness = at_most + closeness(at_most, scale_, 0.0F);
  if (rect.right - rect.left < kCell && rect.bottom - rect.top < kCell) {
    return hides_pixels(rect, nearness);
  }
  for (int row = rect.top / kCell; row <= rect.bottom / kCell; ++row) {
    for (int col = rect.left / kCell; col <= rect.right / kCell; ++col) {
      if (!(least_in(col, row) > nearness)) return false;
    }
  }
  return true;
}

bool Canvas::hides_pixels(const CanvasRect& rect, float nearness) const {
  for (int row = rect.top; row <= rect.bottom; ++row) {
    for (int col = rect.left; col <= rect.right; ++col) {
      if (!(nearness_[place(col, row)] > nearness)) return false;
    }
  }
  return true;
}

void Canvas::mark_drawn(const CanvasRect& rect) {
  for (int row = rect.top / kCell; row <= rect.bottom / kCell; ++row) {
    const std::size_t first = cell_at(rect.left / kCell, row);
    const std::size_t last = cell_at(rect.right / kCell, row);
    for (std::size_t cell = first; cell <= last; ++cell) is_old_[cell] = true;
  }
}

void Canvas::draw(const Shape& shape) {
  draw_blocks(shape, scale_, kBlocks, nearness_.data(), numbers_.data());
}

void Canvas::copy_numbers(std::vector<std::uint32_t>& numbers) const {
  numbers.resize(static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_));
  std::uint32_t* to = numbers.data();
  for (int row = 0; row < rows_; ++row) {
    for (int col = 0; col < cols_; col += kStroke) {
      const int count = std::min(kStroke, cols_ - col);
      to = std::copy_n(&numbers_[place(col, row)], count, to);
    }
  }
}

}  // namespace glidar::raster
