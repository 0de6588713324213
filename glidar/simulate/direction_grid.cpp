// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/direction_grid.hpp>

#include <glidar/math/portable.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace glidar {
namespace {

/// Unit vectors to the centres of all cells: by face, then row, then column.
std::vector<Eigen::Vector3d> make_cell_centres(std::uint32_t side) {
  std::vector<Eigen::Vector3d> centres;
  const double scale = 2.0 / side;
  for (std::uint32_t cell = 0; cell < 6 * side * side; ++cell) {
    const std::uint32_t face = cell / (side * side);
    const auto axis = static_cast<Eigen::Index>(face / 2);
    Eigen::Vector3d centre;
    centre[axis] = face % 2 == 0 ? 1.0 : -1.0;
    centre[(axis + 1) % 3] = scale * (cell % side + 0.5) - 1.0;
    centre[(axis + 2) % 3] = scale * (cell / side % side + 0.5) - 1.0;
    centres.push_back(centre.normalized());
  }
  return centres;
}

}  // namespace

std::uint32_t DirectionGrid::cell_of(const Eigen::Vector3d& direction) {
  Eigen::Index axis = 0;
  const double largest = direction.cwiseAbs().maxCoeff(&axis);
  const auto place = [&](Eigen::Index other) {
    const double across = 0.5 * (direction[other] / largest + 1.0);
    return std::min(static_cast<std::uint32_t>(across * kSide), kSide - 1);
  };
  const auto face = static_cast<std::uint32_t>(2 * axis) + (direction[axis] < 0.0 ? 1U : 0U);
  return (face * kSide + place((axis + 2) % 3)) * kSide + place((axis + 1) % 3);
}

void DirectionGrid::build(const std::vector<Eigen::Vector3d>& directions) {
  begin_.fill(0);
  cells_.assign(directions.size(), kCells);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    if (directions[i].hasNaN()) continue;
    cells_[i] = cell_of(directions[i]);
    ++begin_[cells_[i] + 1];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  indices_.resize(begin_.back());
  std::array<std::uint32_t, kCells + 1> next = begin_;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    if (cells_[i] < kCells) indices_[next[cells_[i]]++] = static_cast<std::uint32_t>(i);
  }
}

void DirectionGrid::find(const Eigen::Vector3d& axis, double angle_rad,
                         std::vector<std::uint32_t>& indices) const {
  // A cell is a square of side 2 / kSide or a smaller part of the sphere: its corners are at most
  // half a diagonal from its centre.
  constexpr double kCellRadius_rad = std::numbers::sqrt2 / kSide;
  static const std::vector<Eigen::Vector3d> kCentres = make_cell_centres(kSide);
  indices.clear();
  const double limit_rad = angle_rad + kCellRadius_rad;
  const double min_cosine = limit_rad < std::numbers::pi ? portable_cos(limit_rad) : -2.0;
  for (std::uint32_t cell = 0; cell < kCells; ++cell) {
    if (begin_[cell] == begin_[cell + 1] || kCentres[cell].dot(axis) < min_cosine) continue;
    indices.insert(indices.end(), indices_.begin() + begin_[cell],
                   indices_.begin() + begin_[cell + 1]);
  }
}

}  // namespace glidar
