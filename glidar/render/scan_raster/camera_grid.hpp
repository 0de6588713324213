// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/render/scan_raster/camera_block.hpp>

#include <string>
#include <vector>

namespace glidar::scan_raster {

/// A quick test on some neighbours. False if the beams are certainly not those of a camera, or most
/// are missing.
bool may_form_image(const Beams& beams);

/// Beams of a camera with any lens: their directions vary smoothly over rows and columns. Sectors
/// are blocks of columns and rows.
class CameraGrid {
 public:
  void measure(const Beams& beams, ThreadPool& thread_pool);

  /// Why the beams form no grid; empty: they do. If not empty, nothing else is valid.
  [[nodiscard]] const std::string& misfit() const { return misfit_; }

  [[nodiscard]] const std::vector<SectorTable>& sectors() const { return sectors_; }
  /// One per sector.
  [[nodiscard]] const std::vector<CameraBlock>& blocks() const { return blocks_; }

  /// Bounds of a sample of the beams, see stereographic_point().
  [[nodiscard]] const Eigen::AlignedBox2d& points() const { return points_; }

 private:
  void find_misfit(const Beams& beams);
  void find_blocks(const Beams& beams, ThreadPool& thread_pool);
  void build_sector(const Beams& beams, std::size_t index);
  void count_drawn();

  std::string misfit_;
  std::vector<CameraBlock> blocks_;
  std::vector<SectorTable> sectors_;
  Eigen::AlignedBox2d points_;
};

}  // namespace glidar::scan_raster
