// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/sensor_options.hpp>

#include <apps/glidar/options/numbers.hpp>
#include <apps/glidar/options/option_kinds.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace glidar::app {
namespace {

constexpr std::int64_t kDefaultSide = 256;  // of the 2015 program, like the field of view
constexpr double kDefaultFov_deg = 20.0;
constexpr double kMaxPixels = 1e9;       // pixels
constexpr double kMaxAmbient = 1e6;      // keeps intensities far from float's end
constexpr double kBytesPerBeam = 250.0;  // beam, truth, measurement and cloud together
constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0;

double memory_bytes() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

void require_memory(std::int64_t width, std::int64_t height) {
  const double needed = kBytesPerBeam * static_cast<double>(width) * static_cast<double>(height);
  if (needed <= memory_bytes()) return;
  throw Error(
      {.where = "image size",
       .found =
           fmt::format("{} x {} pixels take about {:.0f} GiB", width, height, needed / kGibibyte),
       .allowed = fmt::format("this machine's memory, {:.0f} GiB", memory_bytes() / kGibibyte),
       .remedy = "render fewer pixels, or parts of the image (--cx and --cy move it)"});
}

bool camera_given(const SensorFlags& f) {
  return f.width || f.height || f.fov_deg || f.fx || f.fy || f.cx || f.cy;
}

double field_of_view_rad(const SensorFlags& flags, std::int64_t height) {
  const double fov_deg = flags.fov_deg.value_or(kDefaultFov_deg);
  require(fov_deg > 0.0 && fov_deg < 180.0, "--fov", fov_deg, "degrees above 0 and below 180");
  const double fov_rad = fov_deg * std::numbers::pi / 180.0;
  const double focal_px = 0.5 * static_cast<double>(height) / std::tan(0.5 * fov_rad);
  require(focal_px <= kMaxPixels, "--fov", fov_deg,
          "a view so wide that the focal length is at most 1e9 pixels");
  return fov_rad;
}

void check_focal_lengths(const SensorFlags& flags) {
  if (flags.fov_deg && (flags.fx || flags.fy)) {
    throw Error({.where = "--fov and --fx, --fy",
                 .found = "both say how wide the view is",
                 .allowed = "",
                 .remedy = "give one of them"});
  }
  const auto require_focal = [](const char* option, const std::optional<double>& value) {
    if (value) {
      require(*value > 0.0 && *value <= kMaxPixels, option, *value, "pixels above 0, up to 1e9");
    }
  };
  require_focal("--fx", flags.fx);
  require_focal("--fy", flags.fy);
}

void require_centre(const char* option, const std::optional<double>& value) {
  if (value) {
    require(std::abs(*value) <= kMaxPixels, option, *value, "pixels from -1e9 to 1e9");
  }
}

Pinhole make_pinhole(const SensorFlags& flags) {
  const std::int64_t width = flags.width.value_or(kDefaultSide);
  const std::int64_t height = flags.height.value_or(kDefaultSide);
  require_memory(width, height);
  check_focal_lengths(flags);
  require_centre("--cx", flags.cx);
  require_centre("--cy", flags.cy);
  Pinhole pinhole =
      pinhole_from_fov(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                       field_of_view_rad(flags, height));
  PinholeIntrinsics& k = pinhole.intrinsics;
  if (flags.fx || flags.fy) {
    k.fx = flags.fx.value_or(flags.fy.value_or(0.0));  // one given: square pixels
    k.fy = flags.fy.value_or(k.fx);
  }
  k.cx = flags.cx.value_or(k.cx);
  k.cy = flags.cy.value_or(k.cy);
  return pinhole;
}

const SensorOptionNames& option_names() {
  static const SensorOptionNames kNames = {.rate = "--rate",
                                           .columns_per_turn = "--columns-per-turn",
                                           .returns = "--returns",
                                           .visibility = "--visibility",
                                           .rain = "--rain",
                                           .snow = "--snow"};
  return kNames;
}

void apply_limits(const SensorFlags& flags, Limits& limits) {
  if (flags.near_m) {
    require(*flags.near_m >= 0.0 && std::isfinite(*flags.near_m), "--near", *flags.near_m,
            "metres, 0 or above");
    limits.near_m = *flags.near_m;
  }
  if (flags.far_m) {
    require(*flags.far_m > 0.0, "--far", *flags.far_m, "metres above 0, or inf");
    limits.far_m = *flags.far_m;
  }
  if (limits.near_m < limits.far_m) return;
  throw Error({.where = "--near and --far",
               .found = fmt::format("near {} m, far {} m", limits.near_m, limits.far_m),
               .allowed = "near below far",
               .remedy = ""});
}

/// "c,l,q".
std::vector<double> parse_attenuation(std::string_view option, const std::string& text) {
  std::vector<double> n = parse_numbers(option, text, 3, "c,l,q");
  const bool none_below = *std::min_element(n.begin(), n.end()) >= 0.0;
  if (none_below && *std::max_element(n.begin(), n.end()) > 0.0) return n;
  throw Error({.where = std::string(option),
               .found = "'" + text + "'",
               .allowed = "3 numbers from 0, at least one of them above 0",
               .remedy = ""});
}

void apply_light(const SensorFlags& flags, Sensor& sensor) {
  if (sensor.pulse && (flags.ambient || !flags.attenuation.empty())) {
    throw Error({.where = flags.ambient ? "--ambient" : "--attenuation",
                 .found = "the sensor has pulse light",
                 .allowed = "",
                 .remedy = "leave it out, or add --ground-truth"});
  }
  if (flags.ambient) {
    require(*flags.ambient >= 0.0 && *flags.ambient <= kMaxAmbient, "--ambient", *flags.ambient,
            "a number from 0 to 1e6");
    sensor.light.ambient = *flags.ambient;
  }
  if (!flags.attenuation.empty()) {
    const std::vector<double> n = parse_attenuation("--attenuation", flags.attenuation);
    sensor.light.attenuation_constant = n[0];
    sensor.light.attenuation_linear_per_m = n[1];
    sensor.light.attenuation_quadratic_per_m2 = n[2];
  }
  validate(sensor.light);
}

/// --ground-truth leaves the pulsed light out, of which returns are a property.
void refuse_returns_of_ideal(const SensorFlags& flags) {
  if (!flags.ground_truth || flags.returns.empty()) return;
  throw Error({.where = "--returns",
               .found = "--ground-truth leaves the sensor's pulse light out",
               .allowed = "a sensor with pulse light",
               .remedy = "leave one of them out"});
}

}  // namespace

void add_sensor_flags(CLI::App& command, SensorFlags& flags) {
  const std::string group = "Sensor";
  const auto number = [&](const std::string& name, const std::string& form, const std::string& help,
                          std::optional<double>& value) {
    add_number(command, {name, form, help, group}, value);
  };
  const auto side = [&](const std::string& names, const std::string& help,
                        std::optional<std::int64_t>& value) {
    add_whole(command, {names, "PX", help, group}, {1, kMaxImageSide},
              [&value](std::int64_t pixels) { value = pixels; });
  };
  add_text(
      command,
      {"--sensor", "NAME|FILE", "Sensor by name (glidar sensors) or sensor file (YAML)", group},
      flags.file);
  side("-w,--width", "Image width [256]", flags.width);
  side("--height", "Image height (-h is help) [256]", flags.height);
  number("--fov", "DEG", "Vertical field of view [20]", flags.fov_deg);
  number("--fx", "PX", "Focal length along the width [= fy]", flags.fx);
  number("--fy", "PX", "Focal length along the height [= fx]", flags.fy);
  number("--cx", "PX", "Column of the principal point [width / 2]", flags.cx);
  number("--cy", "PX", "Row of the principal point [height / 2]", flags.cy);
  number("--near", "M", "Least depth (LiDAR: range) that is reported [0]", flags.near_m);
  number("--far", "M", "Greatest depth (LiDAR: range) that is reported [inf]", flags.far_m);
  number("--rate", "HZ", "Frames per second; of a spinning sensor: turns", flags.rate_hz);
  add_whole(command,
            {"--columns-per-turn", "N", "Columns of a spinning sensor, for example 2048", group},
            {1, kMaxColumnsPerTurn},
            [&flags](std::int64_t columns) { flags.columns_per_turn = columns; });
  add_option(command,
             {"--returns", "LIST|N",
              "Returns of a pulse (strongest,last), or the N nearest [its own]", group},
             [&flags](std::string_view option, const std::string& text) {
               flags.returns = parse_returns(std::string(option), parse_list(option, text));
             });
  command
      .add_flag("--cull-back-faces", flags.cull_back_faces,
                "Triangles seen from behind let beams through [they are seen]")
      ->group(group);
  command
      .add_flag("--ground-truth", flags.ground_truth,
                "Without noise, pulse light and footprint: the geometric truth")
      ->group(group);
  number("--ambient", "A", "Ambient light of the scene [0.2]", flags.ambient);
  add_text(command,
           {"--attenuation", "C,L,Q", "Light falls as 1/(C + L d + Q d^2) [1,1e-4,1e-8]", group},
           flags.attenuation, parse_attenuation);
  number("--visibility", "M", "Visibility, for pulsed light; 0: no fog [as the sensor says]",
         flags.visibility_m);
  number("--rain", "MM/H", "Rain, for pulsed light [as the sensor says]", flags.rain_mm_per_h);
  number("--snow", "MM/H", "Snow as melted water, for pulsed light [as the sensor says]",
         flags.snow_mm_per_h);
}

bool names_sensor(const SensorFlags& flags) {
  return !flags.file.empty() || camera_given(flags);
}

Sensor make_sensor(const SensorFlags& flags, const Sensor* from_scene_file) {
  Sensor sensor;
  if (!flags.file.empty()) {
    if (camera_given(flags)) {
      throw Error({.where = "--sensor",
                   .found = "camera options such as --width or --fov are given too",
                   .allowed = "",
                   .remedy = "write them into " + flags.file + ", or leave --sensor out"});
    }
    sensor = load_sensor_file(find_sensor_file(flags.file));
  } else if (camera_given(flags) || from_scene_file == nullptr) {
    sensor.optics = make_pinhole(flags);
  } else {
    sensor = *from_scene_file;
  }
  if (const auto* pinhole = std::get_if<Pinhole>(&sensor.optics)) {
    require_memory(pinhole->intrinsics.width, pinhole->intrinsics.height);
  }
  apply_scan(flags, option_names(), sensor);
  apply_limits(flags, sensor.limits);
  if (flags.ground_truth) sensor = ground_truth_sensor(std::move(sensor));
  apply_light(flags, sensor);
  apply_weather(flags, option_names(), sensor);
  refuse_returns_of_ideal(flags);
  apply_returns(flags, option_names(), sensor);
  sensor.cull_back_faces = sensor.cull_back_faces || flags.cull_back_faces;
  return sensor;
}

}  // namespace glidar::app
