// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the project: colours of points in pictures of clouds.

#include <glidar/io/formats/cloud_file.hpp>
#include <glidar/io/pictures/chart.hpp>

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace glidar {

/// The points of a cloud that a picture shows.
struct ShownPoints {
  std::vector<Eigen::Vector3d> points_m;  ///< in a frame with z up
  std::vector<std::size_t> entries;       ///< of the cloud, one per point
};

/// Colours of points and their key: a bar, or a legend for classes and instances.
struct PointColours {
  std::vector<Colour> colours;  ///< one per point
  std::optional<ColourBar> bar;
  std::vector<LegendEntry> legend;  ///< the most frequent first
};

/// Colours points as options.picture specifies: radial velocities blue towards the sensor, white at
/// 0 and red away from it. Throws Error when a camera is to be coloured by ring, or by radial
/// velocities that the sensor does not measure.
PointColours colour_points(const CloudFile& job, const ShownPoints& shown);

}  // namespace glidar
