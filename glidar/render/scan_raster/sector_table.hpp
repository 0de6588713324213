// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/render/scan_raster/sector.hpp>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar::scan_raster {

/// Size of a sector, in cells.
struct SectorShape {
  std::uint32_t columns = 0;  ///< a multiple of kTileColumns
  std::uint32_t rows = 0;     ///< a multiple of kTileRows

  /// The smallest shape for this many columns and rows.
  static SectorShape around(std::uint32_t columns, std::uint32_t rows) {
    return {(columns + kTileColumns - 1) / kTileColumns * kTileColumns,
            (rows + kTileRows - 1) / kTileRows * kTileRows};
  }
  [[nodiscard]] std::uint32_t pitch() const { return columns + kTileColumns; }
  [[nodiscard]] std::uint32_t tile_pitch() const { return (columns / kTileColumns + 7U) / 8U * 8U; }
  [[nodiscard]] std::size_t cells() const { return std::size_t{rows} * pitch(); }
  [[nodiscard]] std::size_t tiles() const { return std::size_t{rows} / kTileRows * tile_pitch(); }
};

/// Axes of a sector in the sensor's frame, as rows of matrices: forward, to the side of rising
/// columns, to that of rising rows.
struct SectorFrame {
  Eigen::Matrix3d sector_from_sensor = Eigen::Matrix3d::Identity();  ///< orthogonal
  Eigen::Matrix3d slopes_from_sensor = Eigen::Matrix3d::Identity();  ///< see Placement
};

/// First beam of a sector's row: at columns below zero, cells have no beam.
struct RowStart {
  std::uint32_t row;
  std::int64_t column;
};

/// Consecutive beams of a row of a sector.
struct SectorRow {
  std::size_t first_beam;
  std::size_t first_cell;
  std::uint32_t count;
};

/// The beams of one sector, in its own frame.
class SectorTable {
 public:
  /// `rows`: at most those of the shape. Missing rows and columns beyond the beams have no beams.
  void build(const Beams& beams, const SectorShape& shape, const SectorFrame& frame,
             std::span<const RowStart> rows);

  [[nodiscard]] SectorView view() const;
  [[nodiscard]] const std::vector<SectorRow>& rows() const { return rows_; }
  /// The beam of a cell; the cell must have one.
  [[nodiscard]] std::size_t beam(std::size_t cell) const {
    return first_beam_[cell / pitch_] + cell % pitch_;
  }

  /// Components of the beams' directions in the sensor's frame, per cell, padded by kLanes.
  [[nodiscard]] const double* exact_direction(int axis) const {
    return exact_direction_[axis].data();
  }

  /// Per cell: infinity, or -1 where there is no beam.
  [[nodiscard]] const std::vector<float>& start() const { return start_; }
  /// Per tile: the maximum of start().
  [[nodiscard]] const std::vector<float>& tile_start() const { return tile_start_; }

  [[nodiscard]] const SectorFrame& frame() const { return frame_; }
  /// The sector's origin in the sensor's frame, metres.
  [[nodiscard]] const Eigen::Vector3d& origin_m() const { return origin_m_; }
  /// Half sizes of a box around the origin, in the sector's frame, that the lines of all beams
  /// cross.
  [[nodiscard]] const Eigen::Vector3d& foot_m() const { return foot_m_; }
  /// Maximum distance behind that crossing at which a beam starts.
  [[nodiscard]] double behind_m() const { return behind_m_; }
  /// Maximum distance from the origin to the start of a beam.
  [[nodiscard]] double distance_m() const { return distance_m_; }

 private:
  void place_rows(const Beams& beams, const SectorShape& shape, std::span<const RowStart> rows);
  void set_directions(const Beams& beams);
  void set_origins(const Beams& beams);
  void find_tiles(const SectorShape& shape);
  void bound_tile(std::size_t tile, std::size_t first_cell);

  SectorFrame frame_;
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d foot_m_ = Eigen::Vector3d::Zero();
  double behind_m_ = 0.0;
  double distance_m_ = 0.0;
  std::uint32_t pitch_ = 1;
  std::vector<SectorRow> rows_;
  std::vector<std::size_t> first_beam_;  ///< per row: of cell 0, which may have none
  std::vector<float> start_;
  std::vector<float> tile_start_;
  std::vector<double> exact_direction_[3];
  std::vector<float> direction_[3];
  std::vector<float> moment_[3];
  std::vector<float> offset_[3];
  Eigen::Vector3f max_moment_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f max_offset_ = Eigen::Vector3f::Zero();
  std::vector<float> tile_middle_[3];
  std::vector<float> tile_half_[3];
};

}  // namespace glidar::scan_raster
