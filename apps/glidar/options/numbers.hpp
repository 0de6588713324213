// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::app {

/// A number, all of the text; also inf and nan. Throws Error naming the option.
double parse_number(std::string_view option, std::string_view text);

/// `count` finite numbers with commas between them. Throws Error naming the option.
std::vector<double> parse_numbers(std::string_view option, std::string_view text, std::size_t count,
                                  std::string_view form);

/// "x,y,z".
Eigen::Vector3d parse_vector(std::string_view option, std::string_view text);

/// These numbers w x y z, of any length but zero, as a rotation. Throws Error naming the option.
Eigen::Quaterniond unit_quaternion(std::string_view option, const std::array<double, 4>& wxyz);

/// "w,x,y,z" of any length but zero, normalised.
Eigen::Quaterniond parse_quaternion(std::string_view option, std::string_view text);

/// "angle,x,y,z": radians about an axis of any length but zero.
Eigen::Quaterniond parse_angle_axis(std::string_view option, std::string_view text);

/// The parts of a list between commas; none of them may be empty. Throws Error naming the option.
std::vector<std::string> parse_list(std::string_view option, std::string_view text);

/// Throws Error naming the option when a coordinate is beyond kMaxCoordinate_m.
void check_reach(std::string_view option, const Eigen::Vector3d& position_m);

/// "x,y,z" in metres, within that.
Eigen::Vector3d parse_position(std::string_view option, std::string_view text);

/// Throws Error naming the option, its value and what is allowed, unless the condition holds.
void require(bool holds, std::string_view option, double value, std::string_view allowed);

}  // namespace glidar::app
