// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/scan_raster/beam_grid.hpp>

#include <memory>
#include <vector>

namespace glidar::scan_raster {

/// The grids of the beams measured last, so that the sensors of a rig take turns at no cost.
class BeamGrids {
 public:
  /// The grid of the beams: measured for these unless it is there already. Valid until the next
  /// call.
  const BeamGrid& of(const Beams& beams, ThreadPool& thread_pool);

 private:
  std::vector<std::unique_ptr<BeamGrid>> grids_;  ///< the one used last first
};

}  // namespace glidar::scan_raster
