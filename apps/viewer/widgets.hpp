// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>

#include <string>

namespace glidar::app {

/// A line of text; zero numbers have no minus sign.
void text(const std::string& line);
/// The same, wrapped at the panel's width.
void wrapped(const std::string& line);

/// Editable position (m) and roll, pitch, yaw (degrees, about the fixed axes x, y, z in this
/// order); true if edited. Values that are not edited keep all digits.
bool edit_pose(const char* name, Pose& pose);

}  // namespace glidar::app
