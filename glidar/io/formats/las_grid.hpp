// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/formats.

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace glidar {

/// Coordinates as LAS stores them: whole multiples of `scale_m` from `offset_m`, per axis.
struct LasGrid {
  double scale_m = 0.0;
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
  std::array<std::vector<std::uint32_t>, 3> counts;  ///< int32 in two's complement
  Eigen::Vector3d min_m = Eigen::Vector3d::Zero();   ///< of the stored coordinates
  Eigen::Vector3d max_m = Eigen::Vector3d::Zero();
};

/// The grid for points x y z, m, all finite. The step is 0.1 mm, or the largest power of ten that
/// is at most a millionth of the cloud's extent if that is finer, or the smallest one with which
/// all points fit 32 bits if that is coarser. The offset is 0 where these steps reach the points
/// and these are within 100 km of the origin.
LasGrid make_las_grid(const std::vector<double>& xyz);

/// The warning for a step by which rounding moves a coordinate by more than kFinePosition_m: by how
/// much, and the remedy. Empty otherwise.
std::string las_rounding_warning(const std::vector<double>& xyz);

}  // namespace glidar
