// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/numbers.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/pose.hpp>

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

namespace glidar::app {
namespace {

[[noreturn]] void throw_bad_value(std::string_view option, std::string found, std::string allowed) {
  throw Error({.where = std::string(option),
               .found = std::move(found),
               .allowed = std::move(allowed),
               .remedy = ""});
}

/// A number, all of the text.
std::optional<double> number(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? std::optional(value) : std::nullopt;
}

}  // namespace

double parse_number(std::string_view option, std::string_view text) {
  const std::optional<double> value = number(text);
  if (!value) throw_bad_value(option, fmt::format("'{}'", text), "a number");
  return *value;
}

std::vector<std::string> parse_list(std::string_view option, std::string_view text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t comma = text.find(',', begin);
    parts.emplace_back(text.substr(begin, comma - begin));
    if (parts.back().empty()) {
      throw_bad_value(option, fmt::format("'{}' has an empty part", text),
                      "parts with one comma between");
    }
    if (comma == std::string_view::npos) return parts;
    begin = comma + 1;
  }
}

std::vector<double> parse_numbers(std::string_view option, std::string_view text, std::size_t count,
                                  std::string_view form) {
  const std::string allowed =
      fmt::format("{} finite numbers {}, with commas and no spaces", count, form);
  std::vector<double> numbers;
  for (const std::string& part : parse_list(option, text)) {
    const std::optional<double> value = number(part);
    if (!value || !std::isfinite(*value))
      throw_bad_value(option, fmt::format("'{}'", part), allowed);
    numbers.push_back(*value);
  }
  if (numbers.size() != count) {
    throw_bad_value(option, fmt::format("'{}' ({} numbers)", text, numbers.size()), allowed);
  }
  return numbers;
}

Eigen::Vector3d parse_vector(std::string_view option, std::string_view text) {
  const std::vector<double> n = parse_numbers(option, text, 3, "x,y,z");
  return {n[0], n[1], n[2]};
}

void check_reach(std::string_view option, const Eigen::Vector3d& position_m) {
  for (const double coordinate : position_m) {
    require(std::abs(coordinate) <= kMaxCoordinate_m, option, coordinate,
            "coordinates from -1e15 to 1e15 m");
  }
}

Eigen::Vector3d parse_position(std::string_view option, std::string_view text) {
  const Eigen::Vector3d position = parse_vector(option, text);
  check_reach(option, position);
  return position;
}

Eigen::Quaterniond unit_quaternion(std::string_view option, const std::array<double, 4>& wxyz) {
  Eigen::Vector4d n(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  if (n.isZero(0.0)) throw_bad_value(option, "a quaternion of length 0", "any other length");
  n.stableNormalize();  // the squares of 1e300 and 1e-300 are beyond double
  return {n[0], n[1], n[2], n[3]};
}

Eigen::Quaterniond parse_quaternion(std::string_view option, std::string_view text) {
  const std::vector<double> n = parse_numbers(option, text, 4, "w,x,y,z");
  return unit_quaternion(option, {n[0], n[1], n[2], n[3]});
}

Eigen::Quaterniond parse_angle_axis(std::string_view option, std::string_view text) {
  const std::vector<double> n = parse_numbers(option, text, 4, "angle,x,y,z (radians, axis)");
  const Eigen::Vector3d axis(n[1], n[2], n[3]);
  if (axis.isZero(0.0)) throw_bad_value(option, "an axis of length 0", "any other length");
  return Eigen::Quaterniond(Eigen::AngleAxisd(n[0], axis.stableNormalized()));
}

void require(bool holds, std::string_view option, double value, std::string_view allowed) {
  if (!holds) throw_bad_value(option, number_text(value), std::string(allowed));
}

}  // namespace glidar::app
