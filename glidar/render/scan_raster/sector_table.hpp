// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/render/scan_raster/beam_angles.hpp>
#include <glidar/render/scan_raster/sector.hpp>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar::scan_raster {

/// How the columns of a grid are cut into sectors.
struct GridColumns {
  std::int32_t first = 0;   ///< the lowest column + shift of any beam
  std::uint32_t count = 0;  ///< from there to the highest
  std::uint32_t width = 0;  ///< columns of a sector
  std::uint32_t rows = 0;   ///< a multiple of kTileRows
  double phase_rad = 0.0;   ///< azimuth of column 0
  double step_rad = 0.0;

  [[nodiscard]] std::uint32_t pitch() const { return width + kTileColumns; }
  [[nodiscard]] std::uint32_t tile_pitch() const { return (width / kTileColumns + 7U) / 8U * 8U; }
  [[nodiscard]] std::size_t cells() const { return std::size_t{rows} * pitch(); }
  [[nodiscard]] std::size_t tiles() const { return std::size_t{rows} / kTileRows * tile_pitch(); }
  [[nodiscard]] std::uint32_t sectors() const { return (count + width - 1) / width; }
};

/// Beams of a row that stand side by side in a sector.
struct SectorRow {
  std::size_t first_beam;
  std::size_t first_cell;
  std::uint32_t count;
};

/// The beams of one sector, in its own frame: forward, to the side of rising columns, up.
class SectorTable {
 public:
  /// `rows`: those of the grid, rising.
  void build(const Beams& beams, std::span<const RowAngles> rows, const GridColumns& columns,
             std::uint32_t index);

  [[nodiscard]] SectorView view() const;
  [[nodiscard]] const std::vector<SectorRow>& rows() const { return rows_; }
  /// The beam of a cell that has one.
  [[nodiscard]] std::size_t beam(std::size_t cell) const {
    return first_beam_[cell / pitch_] + cell % pitch_;
  }

  /// Components of the beams' directions in the sensor's frame, per cell, and kLanes more.
  [[nodiscard]] const double* exact_direction(int axis) const {
    return exact_direction_[axis].data();
  }

  /// Per cell: infinity, or -1 where there is no beam.
  [[nodiscard]] const std::vector<float>& start() const { return start_; }
  /// Per tile: the largest of them.
  [[nodiscard]] const std::vector<float>& tile_start() const { return tile_start_; }

  [[nodiscard]] const Eigen::Matrix3d& sector_from_sensor() const { return sector_from_sensor_; }
  /// In the sensor's frame, metres.
  [[nodiscard]] const Eigen::Vector3d& origin_m() const { return origin_m_; }
  /// Half sizes of a box around the origin, in the sector's frame, that the beams' lines cross.
  [[nodiscard]] const Eigen::Vector3d& foot_m() const { return foot_m_; }
  /// How far behind that crossing a beam may start.
  [[nodiscard]] double behind_m() const { return behind_m_; }
  /// From the origin to where a beam starts, at most.
  [[nodiscard]] double distance_m() const { return distance_m_; }

 private:
  void place_rows(const Beams& beams, std::span<const RowAngles> rows, const GridColumns& columns,
                  std::int32_t first_column);
  void set_directions(const Beams& beams);
  void set_origins(const Beams& beams);
  void find_tiles(const GridColumns& columns);
  void bound_tile(std::size_t tile, std::size_t first_cell);

  Eigen::Matrix3d sector_from_sensor_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d foot_m_ = Eigen::Vector3d::Zero();
  double behind_m_ = 0.0;
  double distance_m_ = 0.0;
  std::uint32_t pitch_ = 1;
  std::vector<SectorRow> rows_;
  std::vector<std::size_t> first_beam_;  ///< per row: of cell 0, were there one
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
