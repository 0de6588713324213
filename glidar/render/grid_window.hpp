// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/plane_points.hpp>
#include <glidar/render/resolver.hpp>

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <span>

namespace glidar {

/// Rows and columns of a beam grid: [first, end) of each.
struct GridWindow {
  std::uint32_t first_row = 0;
  std::uint32_t end_row = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t first_col = 0;
  std::uint32_t end_col = std::numeric_limits<std::uint32_t>::max();

  [[nodiscard]] bool meets(const GridWindow& other) const {
    return first_row < other.end_row && other.first_row < end_row && first_col < other.end_col &&
           other.first_col < end_col;
  }
};

/// The part of a pinhole's grid that may hit something: the projection of all enabled instances'
/// boxes (one per mesh, see bounds()) and one beam more on each side. The whole grid when a corner
/// is not in front of the sensor, and for other beams.
GridWindow visible_window(const Resolver& resolver, std::span<const Eigen::AlignedBox3d> mesh_boxes,
                          std::span<const std::uint8_t> instance_enabled,
                          const PlanePoints& points);

}  // namespace glidar
