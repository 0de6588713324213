// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
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

/// The same for the first of many clouds in one file: the step is at least 0.1 mm, so that the
/// others may be up to 214 km away.
LasGrid make_run_las_grid(const std::vector<double>& xyz);

/// The same with the steps and the offset of another one. Throws Error if the points do not fit.
LasGrid make_las_grid(const std::vector<double>& xyz, const LasGrid& steps);

/// The warning for a step by which rounding moves a coordinate by more than kFinePosition_m: by how
/// much, and the remedy. Empty otherwise.
std::string las_rounding_warning(const std::vector<double>& xyz);

/// The standard class of a name, in any case and with spaces, '-' or '_' between words: LAS
/// Specification 1.4 R15, table 17. 0: it has none.
std::uint8_t las_standard_class(std::string_view name);

/// The code of every class of a scene, by its id: the standard class, or a user-definable code, 63
/// plus the id, up to 255. Unlabelled objects (id 0), and classes of larger ids without a standard
/// class, are 1: unclassified.
std::vector<std::uint8_t> las_class_codes(std::span<const std::string> class_names);

/// The code of points that hit no object of a class.
inline constexpr std::uint8_t kLasUnclassified = 1;

}  // namespace glidar
