// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/stereo/stereo_depth.hpp>
#include <glidar/stereo/stereo_match.hpp>

#include <span>
#include <string>

namespace glidar::app {

/// What the name of a file asks for.
enum class StereoQuantity { depth, disparity, status };

/// "wall_depth.png" is depth. Throws Error for other names.
StereoQuantity stereo_quantity(const std::string& path);

/// Writes all files, which appear together. `read` are files that must not be overwritten. Depth
/// needs a geometry. Throws Error.
void write_stereo_files(std::span<const std::string> paths, std::span<const std::string> read,
                        const StereoMatch& match, const StereoGeometry& geometry);

}  // namespace glidar::app
