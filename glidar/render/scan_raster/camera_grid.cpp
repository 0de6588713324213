// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/camera_grid.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace glidar::scan_raster {
namespace {

/// Sides of a block: enough beams to amortise its traversal of the tree, few enough for buffers
/// that fit a core's private cache and for a good fit of lenses.
constexpr std::uint32_t kMaxSide = 64;
constexpr std::uint32_t kMinSide = 16;

/// Side of equal sections of an image, a multiple of `grain` except for the last.
std::uint32_t piece_length(std::uint32_t whole, std::uint32_t grain) {
  const std::uint32_t pieces = std::max((whole + kMaxSide - 1) / kMaxSide, 1U);
  return ((whole + pieces - 1) / pieces + grain - 1) / grain * grain;
}

/// A beam and its four neighbours.
struct Cross {
  const Eigen::Vector3d& middle;
  const Eigen::Vector3d& left;
  const Eigen::Vector3d& right;
  const Eigen::Vector3d& above;
  const Eigen::Vector3d& below;

  Cross(const Beams& beams, std::size_t i)
      : middle(beams.directions[i]),
        left(beams.directions[i - 1]),
        right(beams.directions[i + 1]),
        above(beams.directions[i - beams.cols]),
        below(beams.directions[i + beams.cols]) {}

  [[nodiscard]] bool is_known() const {
    return middle.allFinite() && left.allFinite() && right.allFinite() && above.allFinite() &&
           below.allFinite();
  }
  /// True if neighbours have about equal distances.
  [[nodiscard]] bool is_even() const {
    const auto is_between = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return (a + b - 2.0 * middle).norm() <= 0.5 * (b - a).norm();
    };
    return is_between(left, right) && is_between(above, below);
  }
};

void add_blocks(const BeamRect& rect, std::uint32_t rows, std::uint32_t columns,
                std::vector<CameraBlock>& blocks) {
  for (std::uint32_t row = rect.first_row; row < rect.end_row; row += rows) {
    for (std::uint32_t column = rect.first_column; column < rect.end_column; column += columns) {
      blocks.emplace_back(BeamRect{row, std::min(row + rows, rect.end_row), column,
                                   std::min(column + columns, rect.end_column)});
    }
  }
}

/// No block contains rows of two returns.
std::vector<CameraBlock> cut_image(const Beams& beams) {
  std::vector<CameraBlock> blocks;
  const std::uint32_t rows = std::max(beams.rows / beams.returns, 1U);
  for (std::uint32_t first = 0; first < beams.rows; first += rows) {
    add_blocks({first, std::min(first + rows, beams.rows), 0, beams.cols},
               piece_length(rows, kTileRows), piece_length(beams.cols, kTileColumns), blocks);
  }
  return blocks;
}

/// False for a block that is too small to be divided.
bool add_quarters(const BeamRect& rect, std::vector<CameraBlock>& blocks) {
  const auto half = [](std::uint32_t whole, std::uint32_t grain) {
    return whole < 2 * kMinSide ? whole : ((whole + 1) / 2 + grain - 1) / grain * grain;
  };
  const std::uint32_t rows = rect.end_row - rect.first_row;
  const std::uint32_t columns = rect.end_column - rect.first_column;
  if (std::max(rows, columns) < 2 * kMinSide) return false;
  add_blocks(rect, half(rows, kTileRows), half(columns, kTileColumns), blocks);
  return true;
}

void measure_blocks(const Beams& beams, ThreadPool& thread_pool, std::vector<CameraBlock>& blocks) {
  thread_pool.parallel_for(blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) blocks[i].measure(beams);
  });
}

}  // namespace

bool may_form_image(const Beams& beams) {
  constexpr std::size_t kProbes = 64;
  if (beams.rows < kMinSide || beams.cols < kMinSide || !beams.origins_m.empty()) return false;
  std::size_t known = 0;
  std::size_t even = 0;
  for (std::size_t k = 0; k < kProbes; ++k) {
    const std::size_t row = 1 + k * (beams.rows - 2) / kProbes;
    // Distributed over the columns, without a regular step.
    const std::size_t column = 1 + k * 7919 % (beams.cols - 2);
    const Cross cross(beams, row * beams.cols + column);
    known += cross.is_known() ? 1 : 0;
    even += cross.is_known() && cross.is_even() ? 1 : 0;
  }
  return 4 * known >= kProbes && 4 * even >= 3 * known;
}

void CameraGrid::measure(const Beams& beams, ThreadPool& thread_pool) {
  blocks_.clear();
  find_misfit(beams);
  if (misfit_.empty()) find_blocks(beams, thread_pool);
  sectors_.resize(blocks_.size());
  thread_pool.parallel_for(blocks_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) build_sector(beams, i);
  });
  points_.setEmpty();
  for (const CameraBlock& block : blocks_) points_.extend(block.points());
  if (misfit_.empty()) count_drawn();
}

void CameraGrid::find_misfit(const Beams& beams) {
  misfit_.clear();
  if (!beams.origins_m.empty()) {
    misfit_ = "beams with origins of their own";
  } else if (beams.rows < kMinSide || beams.cols < kMinSide) {
    misfit_ = "a lens's image with fewer than 16 rows or columns";
  }
}

/// Blocks in which beams deviate much are divided again.
void CameraGrid::find_blocks(const Beams& beams, ThreadPool& thread_pool) {
  std::vector<CameraBlock> blocks = cut_image(beams);
  while (!blocks.empty()) {
    measure_blocks(beams, thread_pool, blocks);
    std::vector<CameraBlock> smaller;
    for (CameraBlock& block : blocks) {
      const bool is_cut = block.is_rough() && add_quarters(block.rect(), smaller);
      if (!is_cut) blocks_.push_back(std::move(block));
    }
    blocks = std::move(smaller);
  }
}

void CameraGrid::build_sector(const Beams& beams, std::size_t index) {
  const CameraBlock& block = blocks_[index];
  std::vector<RowStart> rows;
  for (std::uint32_t row = block.rect().first_row; row < block.rect().end_row; ++row) {
    rows.push_back({row, block.rect().first_column});
  }
  sectors_[index].build(beams, block.shape(), block.frame(), rows);
}

void CameraGrid::count_drawn() {
  std::size_t all = 0;
  std::size_t drawn = 0;
  for (const CameraBlock& block : blocks_) {
    all += block.beams();
    drawn += block.is_drawn() ? block.beams() : 0;
  }
  if (2 * drawn < all) misfit_ = "an image whose directions do not vary smoothly";
}

}  // namespace glidar::scan_raster
