// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/option_values.hpp>

#include <glidar/core/pose.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/core/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace glidar::app {
namespace {

std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

Eigen::Quaterniond unit_quaternion(const std::vector<double>& n, std::size_t first) {
  Eigen::Vector4d wxyz(n[first], n[first + 1], n[first + 2], n[first + 3]);
  if (wxyz.isZero(0.0)) throw Error({"", "a quaternion of length 0", "any other length"});
  wxyz.stableNormalize();  // the squares of 1e300 and 1e-300 are beyond double
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

Eigen::Vector3d position(const std::vector<double>& n) {
  const Eigen::Vector3d position_m(n[0], n[1], n[2]);
  for (const double x : position_m) {
    require_number(std::abs(x) <= kMaxCoordinate_m, "", x, "coordinates from -1e15 to 1e15 m");
  }
  return position_m;
}

}  // namespace

void refuse_value(const std::string& text, std::string allowed, std::string remedy) {
  throw Error({"", "'" + text + "'", std::move(allowed), std::move(remedy)});
}

double parse_number(std::string_view text) {
  const std::optional<double> value = number_in(text);
  if (!value) refuse_value(std::string(text), "a number");
  return *value;
}

std::function<double(const std::string&)> number(double min, double max, std::string allowed) {
  return [min, max, allowed = std::move(allowed)](const std::string& text) {
    const double value = parse_number(text);
    require_number(value >= min && value <= max, "", value, allowed.c_str());
    return value;
  };
}

std::function<std::string(const std::string&)> one_of(std::vector<std::string> names) {
  return [names = std::move(names)](const std::string& text) {
    const auto same = [wanted = lower_case(text)](const std::string& name) {
      return lower_case(name) == wanted;
    };
    const auto named = std::find_if(names.begin(), names.end(), same);
    if (named != names.end()) return *named;
    constexpr std::size_t kMinLength = 3;  // shorter words are close to any name
    const std::string nearest = text.size() < kMinLength ? "" : closest_match(text, names);
    refuse_value(text, fmt::format("{}", fmt::join(names, ", ")),
                 nearest.empty() ? "" : fmt::format("did you mean {}?", nearest));
  };
}

std::vector<std::string> parse_list(const std::string& text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t comma = text.find(',', begin);
    parts.push_back(text.substr(begin, comma - begin));
    if (parts.back().empty()) {
      throw Error({"", "'" + text + "' has an empty part", "parts with one comma between"});
    }
    if (comma == std::string::npos) return parts;
    begin = comma + 1;
  }
}

std::vector<double> parse_numbers(const std::string& text, std::size_t count,
                                  std::string_view form) {
  const std::string allowed =
      fmt::format("{} finite numbers {}, with commas and no spaces", count, form);
  std::vector<double> numbers;
  for (const std::string& part : parse_list(text)) {
    const std::optional<double> value = number_in(part);
    if (!value || !std::isfinite(*value)) refuse_value(part, allowed);
    numbers.push_back(*value);
  }
  if (numbers.size() == count) return numbers;
  throw Error({"", fmt::format("'{}' ({} numbers)", text, numbers.size()), allowed});
}

Eigen::Vector3d parse_vector(const std::string& text) {
  const std::vector<double> n = parse_numbers(text, 3, "x,y,z");
  return {n[0], n[1], n[2]};
}

Eigen::Vector3d parse_scale(const std::string& text) {
  constexpr const char* kAllowed =
      "a number from 1e-15 to 1e15 or its negative, which mirrors, or three of them as x,y,z";
  std::vector<double> factors;
  for (const std::string& part : parse_list(text)) {
    factors.push_back(number(-kMaxScale, kMaxScale, kAllowed)(part));
    require_number(std::abs(factors.back()) >= kMinScale, "", factors.back(), kAllowed);
  }
  if (factors.size() == 1) factors.resize(3, factors[0]);
  if (factors.size() != 3) refuse_value(text, kAllowed);
  return {factors[0], factors[1], factors[2]};
}

Eigen::Vector3d parse_position(const std::string& text) {
  return position(parse_numbers(text, 3, "x,y,z"));
}

Eigen::Quaterniond parse_quaternion(const std::string& text) {
  return unit_quaternion(parse_numbers(text, 4, "w,x,y,z"), 0);
}

Eigen::Quaterniond parse_angle_axis(const std::string& text) {
  const std::vector<double> n = parse_numbers(text, 4, "angle,x,y,z (radians, axis)");
  const Eigen::Vector3d axis(n[1], n[2], n[3]);
  if (axis.isZero(0.0)) throw Error({"", "an axis of length 0", "any other length"});
  return axis_angle(axis.stableNormalized(), n[0]);
}

Pose parse_pose(const std::string& text) {
  const std::vector<double> n = parse_numbers(text, 7, "x,y,z,qw,qx,qy,qz");
  return make_pose(position(n), unit_quaternion(n, 3));
}

std::array<std::uint32_t, 2> parse_pixel(const std::string& text) {
  const std::vector<std::string> parts = parse_list(text);
  if (parts.size() != 2) refuse_value(text, "COLUMN,ROW, for example 320,240");
  const auto parse = whole<std::uint32_t>(0, 0xFFFFFFFF);
  return {parse(parts[0]), parse(parts[1])};
}

std::function<std::array<std::uint32_t, 2>(const std::string&)> image_size(std::uint32_t min,
                                                                           std::uint32_t max) {
  return [min, max](const std::string& text) {
    std::array<std::uint32_t, 2> size = {};
    const char* const end = text.data() + text.size();
    const auto [cross, width_error] = std::from_chars(text.data(), end, size[0]);
    const bool has_cross = width_error == std::errc() && cross != end && *cross == 'x';
    const auto [last, height_error] = std::from_chars(has_cross ? cross + 1 : end, end, size[1]);
    if (!has_cross || height_error != std::errc() || last != end ||
        std::min(size[0], size[1]) < min || std::max(size[0], size[1]) > max) {
      refuse_value(text, fmt::format("WIDTHxHEIGHT in pixels, each from {} to {}", min, max),
                   "for example 1280x720");
    }
    return size;
  };
}

}  // namespace glidar::app
