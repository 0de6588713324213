// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/raster/tile_buffer.hpp>

#include <glidar/math/simd.hpp>

#include <algorithm>
#include <limits>

namespace glidar::raster {
namespace {

constexpr float kEmptyNearness = -1.0F;  // below that of all geometry
constexpr int kBlockWidth = 4;           // pixels of a row that are adjacent in memory
constexpr float kOutside = std::numeric_limits<float>::infinity();

/// Increments of edge functions and nearness at the 16 pixels of a block from its first pixel.
struct BlockSteps {
  Lanes<float> edge_0;
  Lanes<float> edge_1;
  Lanes<float> edge_2;
  Lanes<float> nearness;
};

[[gnu::always_inline]] inline void find_steps(const TriangleSetup& s, BlockSteps& steps) {
  constexpr unsigned kSide = 4;
  for (unsigned i = 0; i < kLanes; ++i) {
    const unsigned down = i / kSide;
    const auto col = static_cast<float>(i % kSide);
    const auto row = static_cast<float>(down);
    steps.edge_0[i] = s.per_col[0] * col + s.per_row[0] * row;
    steps.edge_1[i] = s.per_col[1] * col + s.per_row[1] * row;
    steps.edge_2[i] = s.per_col[2] * col + s.per_row[2] * row;
    steps.nearness[i] = s.nearness_per_col * col + s.nearness_per_row * row;
  }
}

/// The largest increase of an edge function within a block, from its first pixel.
[[gnu::always_inline]] inline float gain(const TriangleSetup& s, std::size_t edge) {
  constexpr float kDepthSteps = 3.0F;
  const float across = s.per_col[edge] > 0.0F ? s.per_col[edge] : 0.0F;
  const float down = s.per_row[edge] > 0.0F ? s.per_row[edge] : 0.0F;
  return kDepthSteps * (across + down);
}

/// A block's pixels, and a triangle's values at its first pixel.
struct Block {
  float* nearness;
  std::uint32_t* triangle_ids;
  std::array<float, 3> edge;
  float setup_nearness;
};

[[gnu::always_inline]] inline void draw_block(const TriangleSetup& s, float scale,
                                              const BlockSteps& steps, const Block& block) {
  float* const nearness = block.nearness;
  std::uint32_t* const triangle_ids = block.triangle_ids;
  for (unsigned i = 0; i < kLanes; ++i) {
    const float b0 = block.edge[0] + steps.edge_0[i];
    const float b1 = block.edge[1] + steps.edge_1[i];
    const float b2 = block.edge[2] + steps.edge_2[i];
    const float free = block.setup_nearness + steps.nearness[i];
    const float low = free < s.farthest ? s.farthest : free;
    const float clamped = low > s.nearest ? s.nearest : low;
    const float previous = nearness[i];
    const std::uint32_t triangle_id = triangle_ids[i];
    const int inside =
        static_cast<int>(b0 >= 0.0F) & static_cast<int>(b1 >= 0.0F) & static_cast<int>(b2 >= 0.0F);
    const float close = closeness(clamped, scale, s.margin);
    const int nearer = static_cast<int>(clamped > previous) |
                       (static_cast<int>(clamped == previous) &
                        static_cast<int>(s.triangle_id < (triangle_id & kTriangleIdMask)));
    const int rough = static_cast<int>(is_rough(clamped, scale, s.margin)) & nearer;
    const int is_close = static_cast<int>(clamped >= previous - close) &
                         static_cast<int>(clamped <= previous + close);
    const int contested = inside & (is_close | rough);
    const int certain = static_cast<int>(b0 >= s.certain[0]) &
                        static_cast<int>(b1 >= s.certain[1]) & static_cast<int>(b2 >= s.certain[2]);
    const bool draws = (inside & nearer) != 0;
    nearness[i] = draws ? clamped : previous;
    const std::uint32_t drawn = s.triangle_id | static_cast<std::uint32_t>(certain) << 31U;
    triangle_ids[i] = (draws ? drawn | (triangle_id & kContestedFlag) : triangle_id) |
                      static_cast<std::uint32_t>(contested) << 30U;
  }
}

/// Evaluates a triangle at a block's first pixel; false where it covers none of the block.
[[gnu::always_inline]] inline bool start_block(const TriangleSetup& s,
                                               const std::array<float, 3>& gains, int col, int row,
                                               Block& block) {
  const auto across = static_cast<float>(col - s.rect.left);
  const auto down = static_cast<float>(row - s.rect.top);
  for (std::size_t k = 0; k < 3; ++k) {
    block.edge[k] = s.at_corner[k] + s.per_col[k] * across + s.per_row[k] * down;
    if (block.edge[k] + gains[k] < 0.0F) return false;
  }
  block.setup_nearness =
      s.nearness_at_corner + s.nearness_per_col * across + s.nearness_per_row * down;
  return true;
}

GLIDAR_SIMD void draw_blocks(const TriangleSetup& s, float scale, std::size_t blocks_in_row,
                             float* nearness, std::uint32_t* triangle_ids) {
  constexpr int kSide = 4;
  BlockSteps steps;
  find_steps(s, steps);
  const std::array<float, 3> gains = {gain(s, 0), gain(s, 1), gain(s, 2)};
  for (int row = s.rect.top / kSide * kSide; row <= s.rect.bottom; row += kSide) {
    const std::size_t first = static_cast<std::size_t>(row / kSide) * blocks_in_row;
    for (int col = s.rect.left / kSide * kSide; col <= s.rect.right; col += kSide) {
      Block block{};
      if (!start_block(s, gains, col, row, block)) continue;
      const std::size_t offset = (first + static_cast<std::size_t>(col / kSide)) * kLanes;
      block.nearness = nearness + offset;
      block.triangle_ids = triangle_ids + offset;
      draw_block(s, scale, steps, block);
    }
  }
}

/// Clears the pixels of adjacent blocks.
GLIDAR_SIMD void fill_blocks(float* nearness, std::uint32_t* triangle_ids, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) nearness[i] = kEmptyNearness;
  for (std::size_t i = 0; i < count; ++i) triangle_ids[i] = kNoTriangleId;
}

/// The minimum of a block's 16 values.
[[gnu::always_inline]] inline float min_of(const float* values) {
  float minimum = values[0];
  for (unsigned i = 1; i < kLanes; ++i) minimum = values[i] < minimum ? values[i] : minimum;
  return minimum;
}

}  // namespace

void TileBuffer::clear(int cols, int rows, float scale) {
  cols_ = cols;
  rows_ = rows;
  scale_ = scale;
  const int used_cols = (cols + kCell - 1) / kCell * kCell;
  const int used_rows = (rows + kCell - 1) / kCell * kCell;
  const std::size_t count = static_cast<std::size_t>(used_cols) * kBlock;
  for (int row = 0; row < used_rows; row += kBlockWidth) {
    fill_blocks(&nearness_[index_of(0, row)], &triangle_ids_[index_of(0, row)], count);
  }
  // Pixels of cells outside of the tile occlude nothing and are not drawn.
  for (int row = 0; row < used_rows; ++row) {
    for (int col = row < rows ? cols : 0; col < used_cols; ++col) {
      nearness_[index_of(col, row)] = kOutside;
    }
  }
  min_nearness_.fill(kEmptyNearness);
  is_stale_.fill(false);
}

float TileBuffer::min_nearness_of(int cell_col, int cell_row) const {
  const float* first = &nearness_[index_of(cell_col * kCell, cell_row * kCell)];
  const float* below = &nearness_[index_of(cell_col * kCell, cell_row * kCell + kCell / 2)];
  return std::min({min_of(first), min_of(first + kLanes), min_of(below), min_of(below + kLanes)});
}

float TileBuffer::min_nearness_in(int cell_col, int cell_row) {
  const std::size_t cell = cell_at(cell_col, cell_row);
  if (is_stale_[cell]) {
    min_nearness_[cell] = min_nearness_of(cell_col, cell_row);
    is_stale_[cell] = false;
  }
  return min_nearness_[cell];
}

bool TileBuffer::is_occluded(const PixelBounds& rect, float max_nearness) {
  const float nearness = max_nearness + closeness(max_nearness, scale_, 0.0F);
  if (rect.right - rect.left < kCell && rect.bottom - rect.top < kCell) {
    return are_pixels_occluded(rect, nearness);
  }
  for (int row = rect.top / kCell; row <= rect.bottom / kCell; ++row) {
    for (int col = rect.left / kCell; col <= rect.right / kCell; ++col) {
      if (!(min_nearness_in(col, row) > nearness)) return false;
    }
  }
  return true;
}

bool TileBuffer::are_pixels_occluded(const PixelBounds& rect, float nearness) const {
  for (int row = rect.top; row <= rect.bottom; ++row) {
    for (int col = rect.left; col <= rect.right; ++col) {
      if (!(nearness_[index_of(col, row)] > nearness)) return false;
    }
  }
  return true;
}

void TileBuffer::mark_stale(const PixelBounds& rect) {
  for (int row = rect.top / kCell; row <= rect.bottom / kCell; ++row) {
    const std::size_t first = cell_at(rect.left / kCell, row);
    const std::size_t last = cell_at(rect.right / kCell, row);
    for (std::size_t cell = first; cell <= last; ++cell) is_stale_[cell] = true;
  }
}

void TileBuffer::draw(const TriangleSetup& setup) {
  draw_blocks(setup, scale_, kBlocks, nearness_.data(), triangle_ids_.data());
}

void TileBuffer::copy_triangle_ids(std::vector<std::uint32_t>& triangle_ids) const {
  triangle_ids.resize(static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_));
  std::uint32_t* to = triangle_ids.data();
  const int rest = cols_ % kBlockWidth;
  for (int row = 0; row < rows_; ++row) {
    for (int col = 0; col < cols_ - rest; col += kBlockWidth) {
      to = std::copy_n(&triangle_ids_[index_of(col, row)], kBlockWidth, to);
    }
    if (rest > 0) to = std::copy_n(&triangle_ids_[index_of(cols_ - rest, row)], rest, to);
  }
}

}  // namespace glidar::raster
