// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/tof/tof_decode.hpp>

#include <span>
#include <string>

namespace glidar::app {

/// What the name of a file asks for.
enum class TofQuantity { depth, range, amplitude, status };

/// "wall_depth.png" is depth. Throws Error for other names.
TofQuantity tof_quantity(const std::string& path);

/// What is written: a result with the cosine of each pixel's direction to the boresight (P; empty:
/// 1), and the unit of PNG images of depth and range.
struct TofResult {
  const TofMeasurement& measured;
  std::span<const float> depth_per_range;
  double unit_m = 0.001;
};

/// Writes all files, which appear together. `read` are files that must not be overwritten. Throws
/// Error.
void write_tof_files(std::span<const std::string> paths, std::span<const std::string> read,
                     const TofResult& result);

}  // namespace glidar::app
