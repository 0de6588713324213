// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/numbers.hpp>

#include <glidar/core/error.hpp>

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>

namespace glidar::app {
namespace {

[[noreturn]] void fail(std::string_view option, std::string found, std::string allowed) {
  throw Error({.where = std::string(option),
               .found = std::move(found),
               .allowed = std::move(allowed),
               .remedy = ""});
}

/// A finite number, all of the text; NaN when it is none.
double number(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(value) ? value : std::nan("");
}

}  // namespace

std::vector<std::string> parse_list(std::string_view option, std::string_view text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t comma = text.find(',', begin);
    parts.emplace_back(text.substr(begin, comma - begin));
    if (parts.back().empty()) {
      fail(option, fmt::format("'{}' has an empty part", text), "parts with one comma between");
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
    numbers.push_back(number(part));
    if (std::isnan(numbers.back())) fail(option, fmt::format("'{}'", part), allowed);
  }
  if (numbers.size() != count) {
    fail(option, fmt::format("'{}' ({} numbers)", text, numbers.size()), allowed);
  }
  return numbers;
}

Eigen::Vector3d parse_vector(std::string_view option, std::string_view text) {
  const std::vector<double> n = parse_numbers(option, text, 3, "x,y,z");
  return {n[0], n[1], n[2]};
}

Eigen::Quaterniond parse_quaternion(std::string_view option, std::string_view text) {
  const std::vector<double> n = parse_numbers(option, text, 4, "w,x,y,z");
  const Eigen::Quaterniond q(n[0], n[1], n[2], n[3]);
  if (!(q.norm() > 0.0)) fail(option, "a quaternion of length 0", "any other length");
  return q.normalized();
}

Eigen::Quaterniond parse_angle_axis(std::string_view option, std::string_view text) {
  const std::vector<double> n = parse_numbers(option, text, 4, "angle,x,y,z (radians, axis)");
  const Eigen::Vector3d axis(n[1], n[2], n[3]);
  if (!(axis.norm() > 0.0)) fail(option, "an axis of length 0", "any other length");
  return Eigen::Quaterniond(Eigen::AngleAxisd(n[0], axis.normalized()));
}

void require_positive(std::string_view option, double value, bool zero_allowed) {
  if (std::isfinite(value) && (value > 0.0 || (zero_allowed && value == 0.0))) return;
  fail(option, fmt::format("{}", value),
       zero_allowed ? "a finite number, 0 or above" : "a finite number above 0");
}

}  // namespace glidar::app
