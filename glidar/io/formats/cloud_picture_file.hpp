// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/cloud_file.hpp>

#include <string>
#include <vector>

namespace glidar {

/// The columns that write_bird_eye and write_perspective need.
std::vector<std::string> cloud_picture_columns();

/// Writes a picture of the cloud from above, x to the right and y up, with axes, coloured by
/// options.picture; the highest point is visible. The cloud is rotated so that z is up.
/// Throws Error when a camera's cloud is to be coloured by ring.
void write_bird_eye(const CloudFile& job, AtomicFile& file);

/// The same in perspective, with a grid on the ground; the nearest point is visible. Also throws
/// Error when the eye is at the target.
void write_perspective(const CloudFile& job, AtomicFile& file);

}  // namespace glidar
