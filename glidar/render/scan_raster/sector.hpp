// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/ray_tree.hpp>

#include <cstdint>
#include <limits>

// What the kernels of the scanner raster read and write. Plain arrays, because code for several
// instruction sets shares them.
namespace glidar::scan_raster {

/// A vector of cells that are tested together; also the width of a tile.
inline constexpr std::uint32_t kTileColumns = 8;
inline constexpr std::uint32_t kTileRows = 4;
/// The table from elevations to rows has this many bins.
inline constexpr std::uint32_t kElevationBins = 4096;
inline constexpr std::uint32_t kNoSlotNumber = std::numeric_limits<std::uint32_t>::max();

/// Rows of equal elevation, found by a table.
struct ElevationRows {
  float lowest_tangent;  ///< of elevations, with room
  float highest_tangent;
  float bins_per_tangent;
  const std::int32_t* first_row;  ///< per bin: lowest row that an elevation from it on may meet
  const std::int32_t* last_row;   ///< per bin: highest row that an elevation up to it may meet
};

/// Rows of equal slopes up / forward.
struct SlopeRows {
  float rows_per_slope;
  float first_row;  ///< of slope 0, less what deviates
  float last_row;   ///< the same, with what deviates
};

/// Where the cells of a sector are. A cell is a row and a column; the axis up is that of rising
/// rows. Columns are those of equal azimuth or, with SlopeRows, of equal slopes side / forward. All
/// is measured from the real directions, so that any beams are inside of these bounds.
struct GridView {
  std::uint32_t rows;     ///< a multiple of kTileRows
  std::uint32_t columns;  ///< a multiple of kTileColumns
  std::uint32_t pitch;    ///< cells from row to row: unaligned vectors reach beyond the last column
  std::uint32_t tile_pitch;  ///< tiles from row to row of tiles, a multiple of 8
  float columns_per_unit;    ///< of azimuth (rad) or of slope
  float middle_column;       ///< where the forward axis points
  float column_margin;       ///< what the kernels' columns may be wrong by
  float max_slope;           ///< of side / forward, with room
  float lowest_slope;        ///< of up / forward, with room
  float highest_slope;
  const float* low_deviation;  ///< per row: of beams from their columns, columns
  const float* high_deviation;
  float min_deviation;  ///< of all rows
  float max_deviation;
  bool has_slopes;  ///< columns and rows are those of slopes
  ElevationRows elevations;
  SlopeRows slopes;
};

/// Some columns of the grid. Vectors are in the sector's frame: forward, to the side of rising
/// columns, up. Cells without a beam repeat a direction.
struct SectorView {
  const float* direction[3];  ///< per cell
  /// Where beams have origins of their own, metres from the sector's origin; otherwise nullptr.
  const float* moment[3];  ///< direction x offset
  const float* offset[3];
  float max_moment[3];  ///< of all beams, per component
  float max_offset[3];
  const float* tile_middle[3];  ///< per tile: of its directions
  const float* tile_half[3];
};

/// What the cells of a sector have found so far.
struct SectorBuffer {
  float* low;  ///< per cell: bounds of the distance, metres; infinite: no hit; -1: no beam
  float* high;
  float* number;            ///< per cell: bits of the number of its triangle, or of kNoSlotNumber
  float* farthest;          ///< per tile: at least the largest `high`
  std::uint32_t* is_stale;  ///< per tile: `farthest` may be larger than that
};

/// One instance, seen from a sector.
struct Placement {
  rays::TreeView tree;
  double origin[3];                ///< of the sector, object units
  float sector_from_object[3][3];  ///< rotation
  /// Into the frame of the sector's slopes, whose axes are unit vectors, but at right angles only
  /// for columns of equal azimuth: there it is the rotation.
  float slopes_from_object[3][3];
  double metres;  ///< per object unit
  /// As RayPacket::rounding.
  double rounding;
  float margin;  ///< what boxes in the sector's frame may be wrong by, object units
  /// Half sizes of a box around the sector's origin that all beams' lines cross, object units; zero
  /// where beams start at the origin. Likewise below.
  float foot[3];
  float behind;                ///< how far behind that crossing a beam may start
  float distance;              ///< from the origin to where a beam starts, at most
  std::uint32_t first_number;  ///< of slot 0
  bool always_retests;  ///< every triangle that is not surely missed goes to retest_exactly()
  /// Applies the hit rule to a cell and a slot.
  void (*retest_exactly)(void* context, std::uint32_t cell, std::uint32_t slot);
  void* context;
};

}  // namespace glidar::scan_raster
