// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/render/lanes.hpp>
#include <glidar/render/resolver.hpp>

#include <Eigen/Geometry>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace glidar {

/// Normalised image coordinates of a pinhole's columns and rows (on the plane at depth 1); empty
/// for other beams. Computing directions from them is faster than reading the directions.
struct PlanePoints {
  std::vector<double> x;  ///< per column
  std::vector<double> y;  ///< per row
};

void find_plane_points(const Beams& beams, PlanePoints& points);

/// direction_through(), lane by lane.
void directions_through(const Lanes<double>& x, const Lanes<double>& y, Lanes3<double>& out);

/// Range of depths that contains all geometry, metres along the boresight; near > 0. Empty (far <=
/// near) when all of it is behind the sensor.
struct DepthRange {
  double near_m;
  double far_m;

  [[nodiscard]] bool is_empty() const { return !(far_m > near_m); }
};

/// The box around a mesh's vertices, relative to its origin; empty for an empty mesh.
Eigen::AlignedBox3d local_box(const Mesh& mesh);

/// Extends the range by the depths of an instance's box (mesh frame, relative to its origin). The
/// nearest depth may be negative.
void extend_depths(const InstanceView& view, const Eigen::AlignedBox3d& box, double& nearest_m,
                   double& farthest_m);

/// Near and far planes just outside of two depths and in front of the sensor.
DepthRange tight_depth_range(double nearest_m, double farthest_m);

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
