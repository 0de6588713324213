// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/sensor.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/core/text.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/optics/sub_pixels.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

template <class T>
void repeat(std::vector<T>& column, std::size_t times) {
  const std::size_t size = column.size();
  column.reserve(size * times);
  for (std::size_t k = 1; k < times; ++k) {
    column.insert(column.end(), column.begin(), column.begin() + static_cast<std::ptrdiff_t>(size));
  }
}

/// Repeats every beam once for each return.
void repeat_for_returns(std::size_t returns, Beams& beams) {
  if (returns == 1) return;
  if (beams.rings.empty()) {
    for (std::size_t i = 0; i < beams.size(); ++i) {
      beams.rings.push_back(static_cast<std::uint16_t>(i / beams.cols));
    }
  }
  repeat(beams.directions, returns);
  repeat(beams.origins_m, returns);
  repeat(beams.times_ns, returns);
  repeat(beams.rings, returns);
  beams.rows *= static_cast<std::uint32_t>(returns);
  beams.returns = static_cast<std::uint32_t>(returns);
  beams.pinhole.reset();  // no longer one grid
}

std::size_t channels_of(const Pinhole& /*optics*/) {
  return 1;
}
std::size_t channels_of(const Spinning& optics) {
  return optics.channels.size();
}
std::size_t channels_of(const LineScan& optics) {
  const bool is_vertical = optics.lines == LineScan::Lines::vertical;
  return is_vertical ? optics.azimuths_rad.size() : optics.elevations_rad.size();
}
std::size_t channels_of(const Prism& optics) {
  return optics.incidence_rad.size();
}
std::size_t channels_of(const WedgeMirror& optics) {
  return optics.incidence_rad.size();
}
std::size_t channels_of(const RayTable& optics) {
  return optics.rows;
}

/// Stereo images are rectified.
void check_pinhole(const ActiveStereo& camera, const Pinhole& pinhole) {
  if (!is_perspective(pinhole)) {
    throw Error({.where = "depth_camera",
                 .found = "the optics have a lens distortion",
                 .allowed = "optics without distortion: stereo images are rectified",
                 .remedy = "remove 'distortion', or 'depth_camera'"});
  }
  check_image(camera, pinhole.intrinsics);
}

void check_pinhole(const TofCamera& camera, const Pinhole& pinhole) {
  validate(camera);
  check_sub_rays(pinhole.intrinsics, camera.sub_rays);
}

void check_pinhole(const StructuredLightCamera& camera, const Pinhole& pinhole) {
  validate(camera);
  check_sub_rays(pinhole.intrinsics, camera.sub_rays);
  check_image(camera, pinhole.intrinsics);
}

}  // namespace

void set_depth_model(DepthModel model, const std::string& where, Sensor& sensor) {
  if (model == DepthModel::physical && !sensor.depth_camera) {
    throw Error({.where = where,
                 .found = "physical, but the sensor '" + sensor.name + "' has no depth_camera",
                 .allowed = "law, or a sensor with a depth_camera such as D435",
                 .remedy = "choose another sensor, or add 'depth_camera' to a sensor file"});
  }
  sensor.depth_model = model;
}

const DepthCamera* physical_camera(const Sensor& sensor) {
  const bool is_physical = sensor.depth_model == DepthModel::physical && sensor.depth_camera;
  return is_physical ? &*sensor.depth_camera : nullptr;
}

void check_depth_camera(const Sensor& sensor) {
  if (!sensor.depth_camera) return;
  const auto* pinhole = std::get_if<Pinhole>(&sensor.optics);
  if (pinhole == nullptr) {
    throw Error({.where = "depth_camera",
                 .found = "the optics are not a pinhole",
                 .allowed = "optics of type pinhole",
                 .remedy = "change 'optics', or remove 'depth_camera'"});
  }
  if (!(sensor.wavelength_m > 0.0)) {
    throw Error({.where = "depth_camera",
                 .found = "no 'wavelength_nm', on which reflectances and photons depend",
                 .allowed = "light of a known wavelength",
                 .remedy = "add 'wavelength_nm: ...'"});
  }
  std::visit([&](const auto& camera) { check_pinhole(camera, *pinhole); }, *sensor.depth_camera);
}

Sensor ground_truth_sensor(Sensor sensor) {
  sensor.lidar_equation.reset();
  sensor.footprint.reset();
  sensor.weather.reset();
  sensor.projector_origin_m.reset();
  sensor.receiver = {};
  if (sensor.doppler) sensor.doppler = Doppler{};
  sensor.noise.clear();
  sensor.depth_model = DepthModel::law;
  return sensor;
}

void set_rate(Sensor& sensor, double rate_hz) {
  require_number(rate_hz >= 1e-6 && rate_hz <= 1e9, "optics, rate", rate_hz,
                 "frames per second from 1e-6 to 1e9");
  sensor.rate_hz = rate_hz;
  if (auto* spinning = std::get_if<Spinning>(&sensor.optics)) spinning->rotation_hz = rate_hz;
  if (auto* raster = std::get_if<LineScan>(&sensor.optics)) raster->scan_hz = rate_hz;
}

void check_weather(const Sensor& sensor) {
  if (!sensor.weather) return;
  if (!sensor.lidar_equation) {
    throw Error({.where = "weather",
                 .found = "the sensor '" + sensor.name + "' has no lidar_equation",
                 .allowed = "weather for a sensor with 'lidar_equation'",
                 .remedy = "add 'lidar_equation' to a sensor file (docs/files.md)"});
  }
  extinction_per_m(*sensor.weather, sensor.wavelength_m);
}

void check_doppler(const Sensor& sensor) {
  if (!sensor.doppler || std::isfinite(sensor.doppler->max_m_s)) return;
  const bool has_false_alarms =
      std::any_of(sensor.noise.begin(), sensor.noise.end(),
                  [](const NoiseStep& step) { return std::holds_alternative<FalseAlarms>(step); });
  if (!has_false_alarms) return;
  throw Error({.where = "doppler",
               .found = "no max_m_s beside the noise step 'false_alarms'",
               .allowed = "a limit up to which the velocities of false alarms are uniform",
               .remedy = "add 'max_m_s: ...' to 'doppler'"});
}

void check_columns(const Sensor& sensor, std::span<const std::string> column_names) {
  const bool is_named =
      std::find(column_names.begin(), column_names.end(), "radial_velocity") != column_names.end();
  if (sensor.doppler || !is_named || column_names.size() == cloud_column_names().size()) return;
  throw Error({.where = "cloud column 'radial_velocity'",
               .found = "the sensor '" + sensor.name + "' does not measure it",
               .allowed = "true_radial_velocity, or a sensor with 'doppler'",
               .remedy = "add 'doppler: {}' to a sensor file (docs/doppler.md)"});
}

std::size_t channel_count(const Optics& optics) {
  return std::visit([](const auto& alternative) { return channels_of(alternative); }, optics);
}

void check_channel_ranges(const Sensor& sensor) {
  if (!sensor.lidar_equation || sensor.lidar_equation->channel_range_m.empty()) return;
  const std::size_t channels = channel_count(sensor.optics);
  const std::size_t found = sensor.lidar_equation->channel_range_m.size();
  if (found == channels) return;
  throw Error({.where = "lidar_equation, channel_range_m",
               .found = std::to_string(found) + " ranges for " + std::to_string(channels) +
                        (channels == 1 ? " channel" : " channels"),
               .allowed = "one range for each channel of the optics",
               .remedy = "add or remove ranges, or leave channel_range_m out"});
}

FrameInterval frame_interval(const Sensor& sensor, std::uint32_t frame) {
  const auto start_of = [&](double count) {
    return static_cast<std::int64_t>(std::llround(count * kSecond_ns / sensor.rate_hz));
  };
  return {start_of(frame), start_of(frame + 1.0)};
}

Beams make_beams(const Sensor& sensor, const FrameInterval& interval) {
  try {
    Beams beams =
        std::visit([&](const auto& optics) { return make_beams(optics, interval); }, sensor.optics);
    repeat_for_returns(sensor.receiver.returns.size(), beams);
    return beams;
  } catch (const Error& error) {
    ErrorParts parts = error.parts();
    parts.where = "sensor '" + excerpt(sensor.name) + "': " + parts.where;
    throw Error(parts);
  }
}

Beams make_beams(const Sensor& sensor) {
  return make_beams(sensor, frame_interval(sensor, 0));
}

}  // namespace glidar
