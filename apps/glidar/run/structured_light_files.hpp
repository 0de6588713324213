// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/staged_files.hpp>
#include <glidar/sensor/depth_camera/structured_light.hpp>

#include <span>
#include <string>
#include <vector>

namespace glidar::app {

/// Decoded images and their depths.
struct MeasuredFringes {
  DecodedFringes decoded;
  std::vector<float> depth_m;
};

/// Throws Error unless every name states its content: depth, coordinate, phase, modulation or
/// status, and .npy, or .png of depth and status.
void check_fringe_outputs(std::span<const std::string> paths);

/// Adds files of the measurement to `files`. Throws Error.
void stage_fringe_files(std::span<const std::string> paths, const MeasuredFringes& measured,
                        double depth_unit_m, StagedFiles& files);

/// Adds pattern_00.png ... in a folder, which is created. Returns their names.
std::vector<std::string> stage_patterns(const std::string& folder, const FringePatterns& patterns,
                                        StagedFiles& files);

}  // namespace glidar::app
