// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/sensor_options.hpp>

#include <apps/glidar/help_text.hpp>
#include <apps/glidar/numbers.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/sensor_file.hpp>
#include <glidar/io/sensor_presets.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <unistd.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace glidar::app {
namespace {

constexpr std::int64_t kDefaultSide = 256;  // of the 2015 program, like the field of view
constexpr double kDefaultFov_deg = 20.0;
constexpr std::int64_t kLargestSide = 65536;  // what make_beams takes
constexpr double kBytesPerBeam = 250.0;       // beam, truth, measurement and cloud together
constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0;

double memory_bytes() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

void require_side(const char* option, std::int64_t pixels) {
  if (pixels >= 1 && pixels <= kLargestSide) return;
  throw Error(
      {.where = option,
       .found = fmt::format("{} pixels", pixels),
       .allowed = fmt::format("1 to {}", kLargestSide),
       .remedy = fmt::format("a frame also has to fit into memory, at about {} bytes a pixel",
                             kBytesPerBeam)});
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

double field_of_view_rad(const SensorFlags& flags) {
  const double fov_deg = flags.fov_deg.value_or(kDefaultFov_deg);
  if (!(fov_deg > 0.0 && fov_deg < 180.0)) {
    throw Error({.where = "--fov",
                 .found = fmt::format("{}", fov_deg),
                 .allowed = "degrees above 0 and below 180",
                 .remedy = ""});
  }
  return fov_deg * std::numbers::pi / 180.0;
}

void check_focal_lengths(const SensorFlags& flags) {
  if (flags.fov_deg && (flags.fx || flags.fy)) {
    throw Error({.where = "--fov and --fx, --fy",
                 .found = "both say how wide the view is",
                 .allowed = "",
                 .remedy = "give one of them"});
  }
  if (flags.fx) require_positive("--fx", *flags.fx);
  if (flags.fy) require_positive("--fy", *flags.fy);
}

void require_finite(const char* option, const std::optional<double>& value) {
  if (!value || std::isfinite(*value)) return;
  throw Error({.where = option,
               .found = fmt::format("{}", *value),
               .allowed = "a finite number of pixels",
               .remedy = ""});
}

Pinhole make_pinhole(const SensorFlags& flags) {
  const std::int64_t width = flags.width.value_or(kDefaultSide);
  const std::int64_t height = flags.height.value_or(kDefaultSide);
  require_side("--width", width);
  require_side("--height", height);
  require_memory(width, height);
  check_focal_lengths(flags);
  require_finite("--cx", flags.cx);
  require_finite("--cy", flags.cy);
  Pinhole pinhole = pinhole_from_fov(static_cast<std::uint32_t>(width),
                                     static_cast<std::uint32_t>(height), field_of_view_rad(flags));
  PinholeIntrinsics& k = pinhole.intrinsics;
  if (flags.fx || flags.fy) {
    k.fx = flags.fx.value_or(flags.fy.value_or(0.0));  // one given: square pixels
    k.fy = flags.fy.value_or(k.fx);
  }
  k.cx = flags.cx.value_or(k.cx);
  k.cy = flags.cy.value_or(k.cy);
  return pinhole;
}

void apply_scan(const SensorFlags& flags, Sensor& sensor) {
  if (flags.rate_hz) {
    require_positive("--rate", *flags.rate_hz);
    set_rate(sensor, *flags.rate_hz);
  }
  if (!flags.columns_per_turn) return;
  auto* spinning = std::get_if<Spinning>(&sensor.optics);
  constexpr std::int64_t kMost = 1 << 20;
  if (spinning == nullptr || *flags.columns_per_turn < 1 || *flags.columns_per_turn > kMost) {
    throw Error({.where = "--columns-per-turn",
                 .found = spinning == nullptr ? "the sensor does not spin"
                                              : fmt::format("{}", *flags.columns_per_turn),
                 .allowed = "1 to 1048576, with a spinning sensor",
                 .remedy = ""});
  }
  spinning->columns_per_turn = static_cast<std::uint32_t>(*flags.columns_per_turn);
}

void apply_limits(const SensorFlags& flags, Limits& limits) {
  if (flags.near_m) {
    require_positive("--near", *flags.near_m, true);
    limits.near_m = *flags.near_m;
  }
  if (flags.far_m) {
    if (!std::isinf(*flags.far_m)) require_positive("--far", *flags.far_m);
    limits.far_m = *flags.far_m;
  }
  if (limits.near_m < limits.far_m) return;
  throw Error({.where = "--near and --far",
               .found = fmt::format("near {} m, far {} m", limits.near_m, limits.far_m),
               .allowed = "near below far",
               .remedy = ""});
}

void apply_light(const SensorFlags& flags, Light& light) {
  if (flags.ambient) {
    require_positive("--ambient", *flags.ambient, true);
    light.ambient = *flags.ambient;
  }
  if (!flags.attenuation.empty()) {
    const std::vector<double> n = parse_numbers("--attenuation", flags.attenuation, 3, "c,l,q");
    light.attenuation_constant = n[0];
    light.attenuation_linear_per_m = n[1];
    light.attenuation_quadratic_per_m2 = n[2];
  }
  validate(light);
}

}  // namespace

void add_sensor_flags(CLI::App& command, SensorFlags& flags) {
  const std::string group = "Sensor";
  command
      .add_option(
          "--sensor", flags.file,
          wrapped("Sensor by name (see glidar sensors) or sensor file (YAML), instead of the "
                  "camera options"))
      ->type_name("NAME|FILE")
      ->group(group);
  const auto add = [&](const std::string& name, auto& value, const std::string& type,
                       const std::string& text) {
    command.add_option(name, value, text)->type_name(type)->group(group);
  };
  add("-w,--width", flags.width, "PX", "Image width [256]");
  add("--height", flags.height, "PX", "Image height (-h is help) [256]");
  add("--fov", flags.fov_deg, "DEG", "Vertical field of view [20]");
  add("--fx", flags.fx, "PX", "Focal length along the width [= fy]");
  add("--fy", flags.fy, "PX", "Focal length along the height [= fx]");
  add("--cx", flags.cx, "PX", "Principal point [width / 2]");
  add("--cy", flags.cy, "PX", "Principal point [height / 2]");
  add("--near", flags.near_m, "M", "Least depth (LiDAR: range) that is reported [0]");
  add("--far", flags.far_m, "M", "Greatest depth (LiDAR: range) that is reported [inf]");
  add("--rate", flags.rate_hz, "HZ", "Frames per second; of a spinning sensor: turns");
  add("--columns-per-turn", flags.columns_per_turn, "N",
      "Columns of a spinning sensor, for example 2048");
  command
      .add_flag("--cull-back-faces", flags.cull_back_faces,
                "Triangles seen from behind let beams through [they are seen]")
      ->group(group);
  add("--ambient", flags.ambient, "A", "Ambient light of the scene [0.2]");
  add("--attenuation", flags.attenuation, "C,L,Q",
      "Light falls as 1/(C + L d + Q d^2) [1,1e-4,1e-8]");
}

Sensor make_sensor(const SensorFlags& flags, const std::optional<Sensor>& from_scene_file) {
  Sensor sensor;
  if (!flags.file.empty()) {
    if (camera_given(flags)) {
      throw Error({.where = "--sensor",
                   .found = "camera options such as --width or --fov are given too",
                   .allowed = "",
                   .remedy = "write them into " + flags.file + ", or leave --sensor out"});
    }
    sensor = load_sensor_file(find_sensor_file(flags.file));
  } else if (camera_given(flags) || !from_scene_file) {
    sensor.optics = make_pinhole(flags);
  } else {
    sensor = *from_scene_file;
  }
  if (const auto* pinhole = std::get_if<Pinhole>(&sensor.optics)) {
    require_memory(pinhole->intrinsics.width, pinhole->intrinsics.height);
  }
  apply_scan(flags, sensor);
  apply_limits(flags, sensor.limits);
  apply_light(flags, sensor.light);
  sensor.cull_back_faces = sensor.cull_back_faces || flags.cull_back_faces;
  return sensor;
}

}  // namespace glidar::app
