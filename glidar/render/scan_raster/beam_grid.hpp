// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/render/scan_raster/camera_grid.hpp>
#include <glidar/render/scan_raster/scanner_grid.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glidar::scan_raster {

/// A quick test on some neighbours. False if the beams certainly form no grid, or most are missing.
bool may_form_grid(const Beams& beams);

/// Beams as a grid of sectors: blocks of an image for cameras; otherwise rows of equal elevation
/// and columns of equal azimuth.
class BeamGrid {
 public:
  void measure(const Beams& beams, ThreadPool& thread_pool);

  /// True if the beams are bit-identical to those measured.
  [[nodiscard]] bool has_measured(const Beams& beams, ThreadPool& thread_pool) const;
  /// Number of measured beams.
  [[nodiscard]] std::size_t size() const { return measured_.size(); }

  [[nodiscard]] bool is_camera() const { return looks_along_z(measured_); }
  [[nodiscard]] const CameraGrid& camera() const { return camera_; }
  [[nodiscard]] const ScannerGrid& scanner() const { return scanner_; }

  /// Why the beams form no grid; empty: they do. If not empty, nothing else is valid.
  [[nodiscard]] const std::string& misfit() const {
    return is_camera() ? camera_.misfit() : scanner_.misfit();
  }
  [[nodiscard]] const std::vector<SectorTable>& sectors() const {
    return is_camera() ? camera_.sectors() : scanner_.sectors();
  }
  [[nodiscard]] GridView view(std::size_t sector) const {
    return is_camera() ? camera_.blocks()[sector].view() : scanner_.view();
  }
  /// False for a sector whose beams are to be cast as rays.
  [[nodiscard]] bool is_drawn(std::size_t sector) const {
    return !is_camera() || camera_.blocks()[sector].is_drawn();
  }
  /// Rows of beams that are in no sector.
  [[nodiscard]] const std::vector<std::uint32_t>& other_rows() const {
    return is_camera() ? no_rows_ : scanner_.other_rows();
  }

 private:
  Beams measured_;  ///< directions, origins, returns and boresight
  CameraGrid camera_;
  ScannerGrid scanner_;
  std::vector<std::uint32_t> no_rows_;
};

}  // namespace glidar::scan_raster
