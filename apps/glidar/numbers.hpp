// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::app {

/// `count` finite numbers with commas between them. Throws Error naming the option.
std::vector<double> parse_numbers(std::string_view option, std::string_view text, std::size_t count,
                                  std::string_view form);

/// "x,y,z".
Eigen::Vector3d parse_vector(std::string_view option, std::string_view text);

/// "w,x,y,z", normalised. Throws Error on zero.
Eigen::Quaterniond parse_quaternion(std::string_view option, std::string_view text);

/// "angle,x,y,z": radians about an axis of any length but zero.
Eigen::Quaterniond parse_angle_axis(std::string_view option, std::string_view text);

/// The parts of a list between commas; none of them may be empty. Throws Error naming the option.
std::vector<std::string> parse_list(std::string_view option, std::string_view text);

/// Throws Error naming the option unless the number is finite and above zero (or zero, when
/// allowed).
void require_positive(std::string_view option, double value, bool zero_allowed = false);

}  // namespace glidar::app
