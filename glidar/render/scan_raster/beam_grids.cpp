// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/beam_grids.hpp>

#include <algorithm>
#include <cstddef>

namespace glidar::scan_raster {
namespace {

/// Limits of the cache: grids, and beams of all grids (some 100 bytes each).
constexpr std::size_t kMaxGrids = 4;
constexpr std::size_t kMaxBeams = std::size_t{1} << 21U;

}  // namespace

const BeamGrid& BeamGrids::of(const Beams& beams, ThreadPool& thread_pool) {
  const auto has_measured = [&](const auto& grid) {
    return grid->has_measured(beams, thread_pool);
  };
  auto found = std::find_if(grids_.begin(), grids_.end(), has_measured);
  if (found == grids_.end()) {
    std::size_t size = beams.size();
    for (const auto& grid : grids_) size += grid->size();
    for (; grids_.size() > 1 && size > kMaxBeams; grids_.pop_back()) size -= grids_.back()->size();
    const bool has_room = grids_.size() < kMaxGrids && size <= kMaxBeams;
    // Otherwise the memory of the oldest grid is reused.
    if (grids_.empty() || has_room) grids_.push_back(std::make_unique<BeamGrid>());
    found = grids_.end() - 1;
    (*found)->measure(beams, thread_pool);
  }
  std::rotate(grids_.begin(), found, found + 1);
  return *grids_.front();
}

}  // namespace glidar::scan_raster
