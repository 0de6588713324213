// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
/// Finds the directions within a cone without looking at all of them.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace glidar {

/// Indices of unit vectors, sorted by cells of equal size on the faces of a cube around the origin.
class DirectionGrid {
 public:
  /// Sorts the indices of the directions that are not NaN; replaces what was there.
  void build(const std::vector<Eigen::Vector3d>& directions);

  /// The indices of all directions within an angle of a unit vector, and of others nearby, in any
  /// order. An angle of pi or more is all of them.
  void find(const Eigen::Vector3d& axis, double angle_rad,
            std::vector<std::uint32_t>& indices) const;

 private:
  static constexpr std::uint32_t kSide = 24;
  static constexpr std::uint32_t kCells = 6 * kSide * kSide;

  static std::uint32_t cell_of(const Eigen::Vector3d& direction);

  std::array<std::uint32_t, kCells + 1> begin_ = {};  ///< where the indices of each cell begin
  std::vector<std::uint32_t> indices_;
  std::vector<std::uint32_t> cells_;  ///< of each direction; memory of build()
};

}  // namespace glidar
