// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/ros: the definitions of single types, without their parts.

#include <glidar/io/ros/codec.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace glidar::ros {

/// The fields of a type, a line each, e.g. of "std_msgs/Header".
std::string fields_of(std::string_view type, Wire wire);

/// The types of these fields that are no numbers and texts.
std::vector<std::string> parts_of(std::string_view type, Wire wire);

}  // namespace glidar::ros
