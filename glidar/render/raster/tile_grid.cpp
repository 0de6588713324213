// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/raster/tile_grid.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace glidar::raster {
namespace {

// Enough parts that threads end together; where they are small, many clusters lie in several.
constexpr double kAimedParts = 24.0;
constexpr double kMinSide = 24.0;
constexpr double kMaxSide = Canvas::kSide - 2.0;

std::uint32_t pieces(std::uint32_t length, double side) {
  return static_cast<std::uint32_t>(std::ceil(length / side));
}

/// Pixels [first - 1, end + 1), as far as there are any.
void widen(std::uint32_t& first, std::uint32_t& count, std::uint32_t all) {
  const std::uint32_t end = std::min(first + count + 1, all);
  first = first == 0 ? 0 : first - 1;
  count = end - first;
}

}  // namespace

void Parts::cut(const GridWindow& window, std::uint32_t rows, std::uint32_t cols) {
  rows_ = rows;
  cols_ = cols;
  window_ = {window.first_row, std::min(window.end_row, rows), window.first_col,
             std::min(window.end_col, cols)};
  const std::uint32_t height = window_.end_row - window_.first_row;
  const std::uint32_t width = window_.end_col - window_.first_col;
  const double side =
      std::clamp(std::sqrt(double{1.0} * height * width / kAimedParts), kMinSide, kMaxSide);
  down_ = pieces(height, side);
  across_ = pieces(width, side);
  height_ = (height + down_ - 1) / down_;
  width_ = (width + across_ - 1) / across_;
  down_ = (height + height_ - 1) / height_;
  across_ = (width + width_ - 1) / width_;
}

Part Parts::part(std::size_t index) const {
  const auto down = static_cast<std::uint32_t>(index / across_);
  const auto across = static_cast<std::uint32_t>(index % across_);
  Part part{};
  part.written.first_row = window_.first_row + down * height_;
  part.written.first_col = window_.first_col + across * width_;
  part.written.rows = std::min(height_, window_.end_row - part.written.first_row);
  part.written.cols = std::min(width_, window_.end_col - part.written.first_col);
  part.drawn = part.written;
  widen(part.drawn.first_row, part.drawn.rows, rows_);
  widen(part.drawn.first_col, part.drawn.cols, cols_);
  return part;
}

/// Calls body(part) for those whose drawn pixels the sighting meets.
template <class Body>
void Parts::for_parts_of(const Sighting& sighting, const Body& body) const {
  const auto place = [](std::int64_t pixel, std::uint32_t first, std::uint32_t side,
                        std::uint32_t count) {
    const std::int64_t at = std::max<std::int64_t>(pixel - first, 0) / side;
    return static_cast<std::uint32_t>(std::min<std::int64_t>(at, count - 1));
  };
  const std::uint32_t first_col =
      place(std::int64_t{sighting.left} - 1, window_.first_col, width_, across_);
  const std::uint32_t last_col =
      place(std::int64_t{sighting.right} + 1, window_.first_col, width_, across_);
  const std::uint32_t first_row =
      place(std::int64_t{sighting.top} - 1, window_.first_row, height_, down_);
  const std::uint32_t last_row =
      place(std::int64_t{sighting.bottom} + 1, window_.first_row, height_, down_);
  for (std::uint32_t row = first_row; row <= last_row; ++row) {
    for (std::uint32_t col = first_col; col <= last_col; ++col) {
      body(std::size_t{row} * across_ + col);
    }
  }
}

void Parts::sort(std::span<const Sighting> sightings) {
  first_.assign(size() + 2, 0);  // shifted by one while the parts are filled
  for (const Sighting& sighting : sightings) {
    for_parts_of(sighting, [&](std::size_t part) { ++first_[part + 2]; });
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  seen_.resize(first_.back());
  for (std::uint32_t i = 0; i < sightings.size(); ++i) {
    for_parts_of(sightings[i], [&](std::size_t part) { seen_[first_[part + 1]++] = i; });
  }
  first_.pop_back();
}

}  // namespace glidar::raster
