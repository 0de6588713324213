// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>

#include <string>

namespace glidar::app {

/// A line of text; numbers in it that are zero have no minus sign.
void text(const std::string& line);
/// The same, broken where the panel ends.
void wrapped(const std::string& line);

/// Position (m) and roll, pitch, yaw (degrees, about the fixed axes x, y, z in this order) to read
/// and to type over; true when they were. What is not typed over keeps all its digits.
bool edit_pose(const char* name, Pose& pose);

}  // namespace glidar::app
