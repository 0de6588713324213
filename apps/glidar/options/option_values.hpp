// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/option_name.hpp>
#include <glidar/core/pose.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace glidar::app {

// Each parser below takes the whole text of an option and throws Error when it is not allowed.

/// Throws Error that quotes the text.
[[noreturn]] void refuse_value(const std::string& text, std::string allowed,
                               std::string remedy = "");

/// A number, also inf and nan.
double parse_number(std::string_view text);

/// The least number above 0, for bounds.
inline constexpr double kAboveZero = std::numeric_limits<double>::denorm_min();
/// The greatest number below infinity, for bounds.
inline constexpr double kFinite = std::numeric_limits<double>::max();

/// A parser of numbers from `min` to `max`, not nan; `allowed` states these bounds in errors.
std::function<double(const std::string&)> number(double min, double max, std::string allowed);

/// A parser of whole numbers from `min` to `max`.
template <std::integral Value>
auto whole(Value min, Value max) {
  return [min, max](const std::string& text) {
    Value value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || value < min || value > max) {
      refuse_value(text,
                   "a whole number from " + std::to_string(min) + " to " + std::to_string(max));
    }
    return value;
  };
}

/// A parser of one of these names; errors suggest the closest one.
std::function<std::string(const std::string&)> one_of(std::vector<std::string> names);

/// A parser of one of these names, which returns the value beside it.
template <class Value>
auto one_of(std::vector<std::pair<std::string, Value>> values) {
  std::vector<std::string> names;
  for (const auto& [name, value] : values) names.push_back(name);
  return [values = std::move(values), parse = one_of(std::move(names))](const std::string& text) {
    const std::string name = parse(text);
    std::size_t i = 0;
    while (values[i].first != name) ++i;
    return values[i].second;
  };
}

/// The parts of a list between commas; none of them may be empty.
std::vector<std::string> parse_list(const std::string& text);

/// `count` finite numbers between commas; `form` describes them in errors.
std::vector<double> parse_numbers(const std::string& text, std::size_t count,
                                  std::string_view form);

/// "x,y,z".
Eigen::Vector3d parse_vector(const std::string& text);

/// "s" or "x,y,z", from kMinScale to kMaxScale without their sign.
Eigen::Vector3d parse_scale(const std::string& text);

/// "x,y,z" in metres, up to kMaxCoordinate_m.
Eigen::Vector3d parse_position(const std::string& text);

/// "w,x,y,z" of any length but zero, normalised.
Eigen::Quaterniond parse_quaternion(const std::string& text);

/// "angle,x,y,z": radians about an axis of any length but zero.
Eigen::Quaterniond parse_angle_axis(const std::string& text);

/// "x,y,z,qw,qx,qy,qz".
Pose parse_pose(const std::string& text);

/// "COLUMN,ROW" of a pixel.
std::array<std::uint32_t, 2> parse_pixel(const std::string& text);

/// A parser of "WIDTHxHEIGHT" in pixels, each from `min` to `max`.
std::function<std::array<std::uint32_t, 2>(const std::string&)> image_size(std::uint32_t min,
                                                                           std::uint32_t max);

}  // namespace glidar::app
