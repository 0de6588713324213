// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_options.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/sensor_calibration.hpp>
#include <glidar/sensor/lidar/return_names.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace glidar {

std::string noise_text(const NoiseStep& step) {
  const nlohmann::ordered_json json = write_struct(FieldVisitor::Mode::report, step);
  std::string text;
  for (const auto& [key, value] : json.items()) {
    if (key == "type") {
      text = value.get<std::string>();
      continue;
    }
    text += (text.find(' ') == std::string::npos ? " " : ", ") + key + " ";
    text += value.is_string() ? value.get<std::string>() : value.dump();
  }
  return text;
}

namespace {

void require(bool holds, const std::string& option, double value, std::string allowed) {
  if (holds) return;
  throw Error(
      {.where = option, .found = number_text(value), .allowed = std::move(allowed), .remedy = ""});
}

[[noreturn]] void refuse_returns(const std::string& option, std::string found, std::string remedy) {
  throw Error({.where = option,
               .found = std::move(found),
               .allowed = fmt::format("1 to {} of {}, with commas and no spaces; or how many of "
                                      "the nearest, 1 to {}",
                                      kMaxReturns, fmt::join(return_names(), ", "), kMaxReturns),
               .remedy = std::move(remedy)});
}

bool is_whole_number(const std::string& word) {
  return !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
}

std::vector<Return> parse_count(const std::string& option, const std::string& word) {
  std::uint32_t count = 0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), count);
  if (problem != std::errc{} || count < 1 || count > kMaxReturns) {
    refuse_returns(option, "'" + excerpt(word) + "'", "");
  }
  return nearest_returns(count);
}

}  // namespace

std::vector<Return> parse_returns(const std::string& option,
                                  const std::vector<std::string>& words) {
  if (words.size() == 1 && is_whole_number(words[0])) return parse_count(option, words[0]);
  const std::vector<std::string> names = return_names();
  std::vector<Return> returns;
  for (const std::string& word : words) {
    if (std::find(names.begin(), names.end(), word) == names.end()) {
      const std::string nearest = closest_match(word, names);
      refuse_returns(option, "'" + excerpt(word) + "'",
                     nearest.empty() ? "" : "did you mean " + nearest + "?");
    }
    returns.push_back(return_named(word));
  }
  if (returns.empty() || returns.size() > kMaxReturns) {
    refuse_returns(option, fmt::format("{} returns", returns.size()), "");
  }
  return returns;
}

DepthModel depth_model_named(const std::string& option, const std::string& name) {
  if (name == "law") return DepthModel::law;
  if (name == "physical") return DepthModel::physical;
  throw Error({.where = option,
               .found = "'" + excerpt(name) + "'",
               .allowed = "law, physical",
               .remedy = ""});
}

void apply_calibrations(const SensorOptions& options, Sensor& sensor) {
  for (const std::string& file : options.calibration_files) apply_calibration(file, sensor);
}

void apply_scan(const SensorOptions& options, const SensorOptionNames& names, Sensor& sensor) {
  if (options.rate_hz) {
    require(*options.rate_hz > 0.0 && std::isfinite(*options.rate_hz), names.rate, *options.rate_hz,
            "hertz above 0");
    set_rate(sensor, *options.rate_hz);
  }
  if (!options.columns_per_turn) return;
  const std::int64_t columns = *options.columns_per_turn;
  if (columns < 1 || columns > kMaxColumnsPerTurn) {
    throw Error({.where = names.columns_per_turn,
                 .found = fmt::format("'{}'", columns),
                 .allowed = fmt::format("a whole number from 1 to {}", kMaxColumnsPerTurn),
                 .remedy = ""});
  }
  auto* spinning = std::get_if<Spinning>(&sensor.optics);
  if (spinning == nullptr) {
    throw Error({.where = names.columns_per_turn,
                 .found = "the sensor does not spin",
                 .allowed = "a spinning sensor",
                 .remedy = "leave it out, or choose a sensor that spins (glidar sensors)"});
  }
  spinning->columns_per_turn = static_cast<std::uint32_t>(columns);
  spinning->firing_period_ns = 0.0;  // the columns decide the time between firing sequences
}

void apply_depth_model(const SensorOptions& options, const SensorOptionNames& names,
                       Sensor& sensor) {
  if (options.depth_model) set_depth_model(*options.depth_model, names.depth_model, sensor);
}

void apply_weather(const SensorOptions& options, const SensorOptionNames& names, Sensor& sensor) {
  if (!options.visibility_m && !options.rain_mm_per_h && !options.snow_mm_per_h) return;
  Weather weather = sensor.weather.value_or(Weather{});
  const auto take = [](const std::string& option, const std::optional<double>& given, double max,
                       double& value) {
    if (!given) return;
    require(*given >= 0.0 && *given <= max, option, *given,
            fmt::format("a number from 0 to {}", max));
    value = *given;
  };
  take(names.visibility, options.visibility_m, kMaxVisibility_m, weather.visibility_m);
  take(names.rain, options.rain_mm_per_h, kMaxFall_mm_per_h, weather.rain_mm_per_h);
  take(names.snow, options.snow_mm_per_h, kMaxFall_mm_per_h, weather.snow_mm_per_h);
  validate(weather);
  sensor.weather = weather;
  check_weather(sensor);
}

void apply_returns(const SensorOptions& options, const SensorOptionNames& names, Sensor& sensor) {
  if (options.returns.empty()) return;
  if (!sensor.lidar_equation) {
    throw Error({.where = names.returns,
                 .found = "the sensor has no pulse light",
                 .allowed = "a sensor with pulse light",
                 .remedy = "leave it out, or choose a sensor such as VLP-16"});
  }
  sensor.receiver.returns = options.returns;
}

}  // namespace glidar
