// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/scan_raster/beam_grid.hpp>

#include <memory>
#include <vector>

namespace glidar::scan_raster {

/// A cache of the last measured grids, so that the sensors of a rig can alternate.
class BeamGrids {
 public:
  /// The grid of the beams, which is measured unless it is cached. Valid until the next call.
  const BeamGrid& of(const Beams& beams, ThreadPool& thread_pool);

 private:
  std::vector<std::unique_ptr<BeamGrid>> grids_;  ///< most recently used first
};

}  // namespace glidar::scan_raster
