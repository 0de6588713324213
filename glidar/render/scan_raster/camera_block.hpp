// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/render/scan_raster/projective_fit.hpp>

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar::scan_raster {

/// Rows and columns of beams, [first, end) of each.
struct BeamRect {
  std::uint32_t first_row = 0;
  std::uint32_t end_row = 0;
  std::uint32_t first_column = 0;
  std::uint32_t end_column = 0;
};

/// The stereographic projection of a direction from -z. The direction need not be a unit vector.
Eigen::Vector2d stereographic_point(const Eigen::Vector3d& direction);

/// A block of a camera's image: it is fitted by a pinhole with axes of its own, and the beams'
/// deviations from that are measured.
class CameraBlock {
 public:
  explicit CameraBlock(const BeamRect& rect) : rect_(rect) {}

  void measure(const Beams& beams);

  [[nodiscard]] const BeamRect& rect() const { return rect_; }
  [[nodiscard]] SectorShape shape() const {
    return SectorShape::around(rect_.end_column - rect_.first_column,
                               rect_.end_row - rect_.first_row);
  }
  [[nodiscard]] const SectorFrame& frame() const { return map_.frame; }
  [[nodiscard]] std::size_t beams() const { return beams_; }
  /// True where beams deviate so much that the block should be divided.
  [[nodiscard]] bool is_rough() const { return is_rough_; }
  /// False where the beams deviate too much: they are cast as rays.
  [[nodiscard]] bool is_drawn() const { return is_drawn_; }
  [[nodiscard]] GridView view() const;
  /// Bounds of a sample of the beams, see stereographic_point().
  [[nodiscard]] const Eigen::AlignedBox2d& points() const { return points_; }

 private:
  void count_beams(const Beams& beams);
  bool fit(const Beams& beams);
  void bound(const Beams& beams);

  BeamRect rect_;
  std::size_t beams_ = 0;
  bool is_rough_ = false;
  bool is_drawn_ = true;
  ProjectiveMap map_;
  Eigen::AlignedBox2d points_;
  std::vector<float> low_deviation_;  ///< per row of the shape
  std::vector<float> high_deviation_;
  GridView view_{};  ///< without the deviations
};

}  // namespace glidar::scan_raster
