// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_document.hpp>

#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/sensor_keys.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace glidar {
namespace {

using Json = nlohmann::ordered_json;

/// What the numbers of a key have in real sensors, from data sheets of LiDARs and depth cameras.
struct UsualRange {
  std::string_view key;
  double min;
  double max;
  bool is_spread;  ///< of the largest and smallest number of a list
  const char* guess;
};

constexpr std::array kUsual = {
    UsualRange{"elevation_deg", 1.0, 360.0, true, "are these radians?"},
    UsualRange{"rate_hz", 0.01, 1e4, false, "is this a period or a rate of points?"},
    UsualRange{"wavelength_nm", 200.0, 20'000.0, false, "is this in micrometres?"},
    UsualRange{"reference_reflectance", 0.001, 1.5, false, "is this in percent?"},
    UsualRange{"divergence_mrad", 0.01, 100.0, false, "is this in degrees or radians?"},
    UsualRange{"baseline_m", 0.001, 5.0, false, "is this in millimetres?"},
    UsualRange{"sigma_m", 0.0, 3.0, false, "is this in millimetres?"},
    UsualRange{"sigma_per_m", 0.0, 0.2, false, "is this in percent?"},
    UsualRange{"step_m", 0.0, 1.0, false, "is this in millimetres?"}};

std::vector<double> numbers_in(const Json& value) {
  if (value.is_number()) return {value.get<double>()};
  std::vector<double> numbers;
  if (!value.is_array()) return numbers;
  for (const Json& one : value) {
    if (one.is_number()) numbers.push_back(one.get<double>());
  }
  return numbers;
}

void check_usual(const std::string& path, std::string_view key, const Json& value,
                 std::vector<std::string>& sentences) {
  const std::vector<double> numbers = numbers_in(value);
  if (numbers.empty()) return;
  const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
  if (*least == 0.0 && *most == 0.0) return;  // unknown
  for (const UsualRange& usual : kUsual) {
    if (usual.key != key || (usual.is_spread && numbers.size() < 2)) continue;
    const bool is_usual =
        usual.is_spread ? *most - *least >= usual.min : *least >= usual.min && *most <= usual.max;
    if (is_usual) continue;
    sentences.push_back(
        usual.is_spread
            ? fmt::format("{}: from {:g} to {:g}; usual: at least {:g} between them; {}", path,
                          *least, *most, usual.min, usual.guess)
            : fmt::format("{}: {:g}; usual: {:g} to {:g}; {}", path,
                          *least < usual.min ? *least : *most, usual.min, usual.max, usual.guess));
  }
}

void check_all(const std::string& path, const Json& value, std::vector<std::string>& sentences) {
  if (!value.is_structured()) return;
  for (const auto& [key, inner] : value.items()) {
    const std::string place = value.is_array()
                                  ? fmt::format("{}[{}]", path, key)
                                  : fmt::format("{}{}{}", path, path.empty() ? "" : ".", key);
    check_usual(place, key, inner, sentences);
    check_all(place, inner, sentences);
  }
}

}  // namespace

std::string sensor_document(const Sensor& sensor) {
  return write_struct(FieldVisitor::Mode::document, sensor_keys(sensor)).dump();
}

std::vector<std::string> implausible_numbers(const Sensor& sensor) {
  std::vector<std::string> sentences;
  check_all("", write_struct(FieldVisitor::Mode::report, sensor_keys(sensor)), sentences);
  return sentences;
}

}  // namespace glidar
