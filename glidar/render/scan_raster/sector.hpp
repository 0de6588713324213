// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/ray_tree.hpp>

#include <cstdint>
#include <limits>

// Inputs and outputs of the kernels of the scanner raster. Plain arrays, because code for several
// instruction sets shares them.
namespace glidar::scan_raster {

/// Width of a vector of cells that are tested together, and of a tile.
inline constexpr std::uint32_t kTileColumns = 8;
inline constexpr std::uint32_t kTileRows = 4;
/// Number of bins of the table from elevations to rows.
inline constexpr std::uint32_t kElevationBins = 4096;
inline constexpr std::uint32_t kNoSlotNumber = std::numeric_limits<std::uint32_t>::max();

/// Rows of equal elevation, found by a table.
struct ElevationRows {
  float lowest_tangent;  ///< of elevations, with a margin
  float highest_tangent;
  float bins_per_tangent;
  const std::int32_t* first_row;  ///< per bin: lowest row that an elevation from it on may meet
  const std::int32_t* last_row;   ///< per bin: highest row that an elevation up to it may meet
};

/// Rows of equal slopes up / forward.
struct SlopeRows {
  float rows_per_slope;
  float first_row;  ///< of slope 0, minus deviations
  float last_row;   ///< of slope 0, plus deviations
};

/// Positions of a sector's cells. A cell has a row and a column; the up axis points to rising rows.
/// Columns have equal azimuth or, with SlopeRows, equal slopes side / forward. All bounds are
/// measured from the actual directions, so they hold for any beams.
struct GridView {
  std::uint32_t rows;        ///< a multiple of kTileRows
  std::uint32_t columns;     ///< a multiple of kTileColumns
  std::uint32_t pitch;       ///< cells from row to row: with padding for unaligned vectors
  std::uint32_t tile_pitch;  ///< tiles from row to row of tiles, a multiple of 8
  float columns_per_unit;    ///< of azimuth (rad) or of slope
  float middle_column;       ///< where the forward axis points
  float column_margin;       ///< error bound of the kernels' columns
  float max_slope;           ///< of side / forward, with a margin
  float lowest_slope;        ///< of up / forward, with a margin
  float highest_slope;
  const float* low_deviation;  ///< per row: of beams from their columns, columns
  const float* high_deviation;
  float min_deviation;  ///< of all rows
  float max_deviation;
  bool has_slopes;  ///< columns and rows have equal slopes
  ElevationRows elevations;
  SlopeRows slopes;
};

/// The beams of a sector. Vectors are in the sector's frame: forward, to the side of rising
/// columns, up. Cells without a beam repeat a direction.
struct SectorView {
  const float* direction[3];  ///< per cell
  /// For beams with separate origins, metres from the sector's origin; otherwise nullptr.
  const float* moment[3];  ///< direction x offset
  const float* offset[3];
  float max_moment[3];  ///< of all beams, per component
  float max_offset[3];
  const float* tile_middle[3];  ///< per tile: of its directions
  const float* tile_half[3];
};

/// The nearest hits of a sector's cells so far.
struct SectorBuffer {
  float* low;  ///< per cell: bounds of the distance, metres; infinite: no hit; -1: no beam
  float* high;
  float* number;            ///< per cell: bits of the number of its triangle, or of kNoSlotNumber
  float* farthest;          ///< per tile: at least the largest `high`
  std::uint32_t* is_stale;  ///< per tile: `farthest` may be larger than that
};

/// One instance in the frame of a sector.
struct Placement {
  rays::TreeView tree;
  double origin[3];                ///< of the sector, object units
  float sector_from_object[3][3];  ///< rotation
  /// Into the frame of the sector's slopes. Its axes are unit vectors, but perpendicular only for
  /// columns of equal azimuth, where it is the rotation.
  float slopes_from_object[3][3];
  double metres;  ///< per object unit
  /// As RayPacket::rounding.
  double rounding;
  float margin;  ///< error bound of boxes in the sector's frame, object units
  /// Half sizes of a box around the sector's origin that the lines of all beams cross, object
  /// units; zero where beams start at the origin. `behind` and `distance` are zero there too.
  float foot[3];
  float behind;                ///< maximum distance behind that crossing at which a beam starts
  float distance;              ///< maximum distance from the origin to the start of a beam
  std::uint32_t first_number;  ///< of slot 0
  bool always_retests;         ///< also triangles that are certainly hit are re-tested
  /// Applies the hit rule to a cell and a slot.
  void (*retest_exactly)(void* context, std::uint32_t cell, std::uint32_t slot);
  void* context;
};

}  // namespace glidar::scan_raster
