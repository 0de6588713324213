// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/sector_table.hpp>

#include <glidar/core/pose.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/render/lanes.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace glidar::scan_raster {
namespace {

constexpr float kNoBeam = -1.0F;
/// Relative rounding of bounds to single precision.
constexpr double kSectorMargin = 1.0 + 0x1p-20;

/// Other beams hit nothing, see rays::BeamSearch.
bool is_beam(const Beams& beams, std::size_t i) {
  return beams.directions[i].allFinite() &&
         (beams.origins_m.empty() || beams.origins_m[i].lpNorm<1>() <= 3.0 * kMaxCoordinate_m);
}

}  // namespace

void SectorTable::build(const Beams& beams, const SectorShape& shape, const SectorFrame& frame,
                        std::span<const RowStart> rows) {
  frame_ = frame;
  pitch_ = shape.pitch();
  start_.assign(shape.cells(), kNoBeam);
  place_rows(beams, shape, rows);
  set_directions(beams);
  set_origins(beams);
  find_tiles(shape);
}

void SectorTable::place_rows(const Beams& beams, const SectorShape& shape,
                             std::span<const RowStart> rows) {
  rows_.clear();
  first_beam_.clear();
  const auto cols = static_cast<std::int64_t>(beams.cols);
  for (std::size_t j = 0; j < rows.size(); ++j) {
    const std::size_t row_start = std::size_t{rows[j].row} * beams.cols;
    const std::int64_t start = rows[j].column;
    const std::int64_t begin = std::clamp<std::int64_t>(start, 0, cols);
    const std::int64_t end = std::clamp<std::int64_t>(start + shape.columns, 0, cols);
    // Below zero it wraps around, which adding a cell's column undoes.
    first_beam_.push_back(row_start + static_cast<std::size_t>(start));
    rows_.push_back({row_start + static_cast<std::size_t>(begin),
                     j * pitch_ + static_cast<std::size_t>(begin - start),
                     static_cast<std::uint32_t>(std::max<std::int64_t>(end - begin, 0))});
    for (std::uint32_t i = 0; i < rows_.back().count; ++i) {
      if (!is_beam(beams, rows_.back().first_beam + i)) continue;
      start_[rows_.back().first_cell + i] = kInfinityf;
    }
  }
}

void SectorTable::set_directions(const Beams& beams) {
  for (int axis = 0; axis < 3; ++axis) {
    direction_[axis].resize(start_.size());
    exact_direction_[axis].resize(start_.size() + kLanes);
  }
  // Cells without a beam repeat the previous direction, which is arbitrary.
  const auto first = std::find(start_.begin(), start_.end(), kInfinityf);
  Eigen::Vector3d exact = Eigen::Vector3d::UnitX();
  if (first != start_.end()) {
    exact = beams.directions[beam(static_cast<std::size_t>(first - start_.begin()))];
  }
  for (std::size_t cell = 0; cell < start_.size(); ++cell) {
    if (start_[cell] == kInfinityf) exact = beams.directions[beam(cell)];
    const Eigen::Vector3f turned = (frame_.sector_from_sensor * exact).cast<float>();
    for (int axis = 0; axis < 3; ++axis) {
      exact_direction_[axis][cell] = exact[axis];
      direction_[axis][cell] = turned[axis];
    }
  }
}

void SectorTable::set_origins(const Beams& beams) {
  origin_m_.setZero();
  foot_m_.setZero();
  behind_m_ = 0.0;
  distance_m_ = 0.0;
  max_moment_.setZero();
  max_offset_.setZero();
  for (int axis = 0; axis < 3; ++axis) {
    moment_[axis].clear();
    offset_[axis].clear();
  }
  if (beams.origins_m.empty()) return;
  const auto for_beams = [&](const auto& visit) {
    for (std::size_t cell = 0; cell < start_.size(); ++cell) {
      if (start_[cell] == kInfinityf) visit(cell, beam(cell));
    }
  };
  // Only the lines matter, so the middle of the lines' feet is the sector's origin.
  Eigen::AlignedBox3d starts;
  for_beams([&](std::size_t, std::size_t i) { starts.extend(beams.origins_m[i]); });
  if (starts.isEmpty()) return;
  const auto foot_from = [&](const Eigen::Vector3d& from, std::size_t i) -> Eigen::Vector3d {
    const Eigen::Vector3d offset = beams.origins_m[i] - from;
    return offset - offset.dot(beams.directions[i]) * beams.directions[i];
  };
  Eigen::AlignedBox3d feet;
  for_beams([&](std::size_t, std::size_t i) {
    feet.extend(starts.center() + foot_from(starts.center(), i));
  });
  origin_m_ = feet.center();
  for (int axis = 0; axis < 3; ++axis) {
    moment_[axis].assign(start_.size(), 0.0F);
    offset_[axis].assign(start_.size(), 0.0F);
  }
  for_beams([&](std::size_t cell, std::size_t i) {
    const Eigen::Vector3d offset = frame_.sector_from_sensor * (beams.origins_m[i] - origin_m_);
    const Eigen::Vector3d direction = frame_.sector_from_sensor * beams.directions[i];
    // The sector's frame may be left-handed, so the cross product is computed in the sensor's
    // frame.
    const Eigen::Vector3d product = beams.directions[i].cross(beams.origins_m[i] - origin_m_);
    const Eigen::Vector3f moment = (frame_.sector_from_sensor * product).cast<float>();
    const Eigen::Vector3f rounded = offset.cast<float>();
    for (int axis = 0; axis < 3; ++axis) {
      moment_[axis][cell] = moment[axis];
      offset_[axis][cell] = rounded[axis];
    }
    max_moment_ = max_moment_.cwiseMax(moment.cwiseAbs());
    max_offset_ = max_offset_.cwiseMax(rounded.cwiseAbs());
    const Eigen::Vector3d foot = frame_.sector_from_sensor * foot_from(origin_m_, i);
    foot_m_ = foot_m_.cwiseMax(kSectorMargin * foot.cwiseAbs());
    behind_m_ = std::max(behind_m_, -kSectorMargin * offset.dot(direction));
    distance_m_ = std::max(distance_m_, kSectorMargin * offset.norm());
  });
}

void SectorTable::find_tiles(const SectorShape& shape) {
  tile_start_.assign(shape.tiles(), kNoBeam);
  for (int axis = 0; axis < 3; ++axis) {
    tile_middle_[axis].assign(shape.tiles(), 0.0F);
    tile_half_[axis].assign(shape.tiles(), 0.0F);
  }
  for (std::size_t y = 0; y < shape.rows / kTileRows; ++y) {
    for (std::size_t x = 0; x < shape.columns / kTileColumns; ++x) {
      bound_tile(y * shape.tile_pitch() + x, y * kTileRows * pitch_ + x * kTileColumns);
    }
  }
}

void SectorTable::bound_tile(std::size_t tile, std::size_t first_cell) {
  Eigen::AlignedBox3f box;
  for (std::size_t i = 0; i < std::size_t{kTileRows} * kTileColumns; ++i) {
    const std::size_t cell = first_cell + i / kTileColumns * pitch_ + i % kTileColumns;
    if (start_[cell] < 0.0F) continue;
    tile_start_[tile] = std::max(tile_start_[tile], start_[cell]);
    box.extend(Eigen::Vector3f(direction_[0][cell], direction_[1][cell], direction_[2][cell]));
  }
  if (box.isEmpty()) return;
  for (int axis = 0; axis < 3; ++axis) {
    tile_middle_[axis][tile] = box.center()[axis];
    tile_half_[axis][tile] = 0.5F * box.sizes()[axis] + 0x1p-22F;
  }
}

SectorView SectorTable::view() const {
  SectorView view{};
  for (int axis = 0; axis < 3; ++axis) {
    view.direction[axis] = direction_[axis].data();
    view.moment[axis] = moment_[axis].empty() ? nullptr : moment_[axis].data();
    view.offset[axis] = offset_[axis].empty() ? nullptr : offset_[axis].data();
    view.max_moment[axis] = max_moment_[axis];
    view.max_offset[axis] = max_offset_[axis];
    view.tile_middle[axis] = tile_middle_[axis].data();
    view.tile_half[axis] = tile_half_[axis].data();
  }
  return view;
}

}  // namespace glidar::scan_raster
