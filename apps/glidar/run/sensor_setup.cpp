// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/sensor_setup.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/math/portable.hpp>

#include <fmt/format.h>

#include <unistd.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace glidar::app {
namespace {

constexpr std::uint32_t kDefaultSide = 256;  // of the original GLIDAR, like the field of view
constexpr double kDefaultFov_deg = 20.0;
constexpr double kMaxFocalLength_px = 1e9;
constexpr double kBytesPerBeam = 250.0;  // beam, ground truth, measurement and cloud together
constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0;

double memory_bytes() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

void require_memory(std::uint32_t width, std::uint32_t height) {
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

double field_of_view_rad(const SensorFlags& flags, std::uint32_t height) {
  const double fov_deg = flags.fov_deg.value_or(kDefaultFov_deg);
  const double fov_rad = fov_deg * std::numbers::pi / 180.0;
  const double focal_px = 0.5 * static_cast<double>(height) / portable_tan(0.5 * fov_rad);
  require_number(focal_px <= kMaxFocalLength_px, "--fov", fov_deg,
                 "a field of view with a focal length of at most 1e9 pixels");
  return fov_rad;
}

Pinhole make_pinhole(const SensorFlags& flags) {
  const std::uint32_t width = flags.width.value_or(kDefaultSide);
  const std::uint32_t height = flags.height.value_or(kDefaultSide);
  require_memory(width, height);
  Pinhole pinhole = pinhole_from_fov(width, height, field_of_view_rad(flags, height));
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
                                           .depth_model = "--depth-model",
                                           .returns = "--returns",
                                           .visibility = "--visibility",
                                           .rain = "--rain",
                                           .snow = "--snow"};
  return kNames;
}

void apply_limits(const SensorFlags& flags, Limits& limits) {
  limits.near_m = flags.near_m.value_or(limits.near_m);
  limits.far_m = flags.far_m.value_or(limits.far_m);
  if (limits.near_m < limits.far_m) return;
  throw Error({.where = "--near and --far",
               .found = fmt::format("near {} m, far {} m", limits.near_m, limits.far_m),
               .allowed = "near below far"});
}

void apply_light(const SensorFlags& flags, Sensor& sensor) {
  if (sensor.lidar_equation && (flags.ambient || flags.attenuation)) {
    throw Error({.where = flags.ambient ? "--ambient" : "--attenuation",
                 .found = "the sensor has pulsed light",
                 .remedy = "leave it out, or add --ground-truth"});
  }
  PhongHeadlight& light = sensor.light;
  light.ambient = flags.ambient.value_or(light.ambient);
  if (const auto& attenuation = flags.attenuation) {
    light.attenuation_constant = (*attenuation)[0];
    light.attenuation_linear_per_m = (*attenuation)[1];
    light.attenuation_quadratic_per_m2 = (*attenuation)[2];
  }
  validate(light);
}

void refuse_calibration_without_sensor(const SensorFlags& flags) {
  if (flags.calibration_files.empty()) return;
  throw Error({.where = "--calibration",
               .found = "there is no --sensor, and no sensor of a scene file",
               .allowed = "the calibration of a sensor preset or sensor file",
               .remedy = "add '--sensor NAME'"});
}

/// --ground-truth removes the pulsed light, of which returns are a property.
void refuse_returns_of_ground_truth(const SensorFlags& flags) {
  if (!flags.ground_truth || flags.returns.empty()) return;
  throw Error({.where = "--returns",
               .found = "--ground-truth removes the pulsed light of the sensor",
               .allowed = "a sensor with pulsed light",
               .remedy = "leave one of them out"});
}

}  // namespace

Sensor load_sensor(const std::string& name_or_path, const std::string& mode) {
  Sensor sensor;
  with_mode_option([&] { sensor = load_sensor_file(find_sensor_file(name_or_path, mode)); });
  return sensor;
}

bool names_sensor(const SensorFlags& flags) {
  return !flags.file.empty() || camera_given(flags);
}

Sensor make_sensor(const SensorFlags& flags, const Sensor* from_scene_file) {
  Sensor sensor;
  if (!flags.file.empty()) {
    sensor = load_sensor(flags.file, flags.mode);
  } else if (camera_given(flags) || from_scene_file == nullptr) {
    refuse_calibration_without_sensor(flags);
    sensor.optics = make_pinhole(flags);
  } else {
    sensor = *from_scene_file;
  }
  if (const auto* pinhole = std::get_if<Pinhole>(&sensor.optics)) {
    require_memory(pinhole->intrinsics.width, pinhole->intrinsics.height);
  }
  apply_calibrations(flags, sensor);
  apply_scan(flags, option_names(), sensor);
  apply_limits(flags, sensor.limits);
  apply_depth_model(flags, option_names(), sensor);
  if (flags.ground_truth) sensor = ground_truth_sensor(std::move(sensor));
  apply_light(flags, sensor);
  apply_weather(flags, option_names(), sensor);
  refuse_returns_of_ground_truth(flags);
  apply_returns(flags, option_names(), sensor);
  sensor.cull_back_faces = sensor.cull_back_faces || flags.cull_back_faces;
  return sensor;
}

}  // namespace glidar::app
