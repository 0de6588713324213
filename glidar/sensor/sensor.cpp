// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/sensor.hpp>

#include <glidar/core/error.hpp>

#include <cmath>

namespace glidar {

void set_rate(Sensor& sensor, double rate_hz) {
  require_optics(rate_hz > 0.0 && std::isfinite(rate_hz), "rate", rate_hz,
                 "a finite number of frames per second above 0");
  sensor.rate_hz = rate_hz;
  if (auto* spinning = std::get_if<Spinning>(&sensor.optics)) spinning->rotation_hz = rate_hz;
  if (auto* raster = std::get_if<Raster>(&sensor.optics)) raster->scan_hz = rate_hz;
}

std::optional<PulseLight> light_in_weather(const Sensor& sensor) {
  if (!sensor.weather) return sensor.pulse;
  if (!sensor.pulse) {
    throw Error({.where = "weather",
                 .found = "the light of the sensor '" + sensor.name + "' is not pulsed",
                 .allowed = "weather for a sensor with 'pulse_light'",
                 .remedy = "describe its light by 'pulse_light' in a sensor file (docs/files.md)"});
  }
  std::optional<PulseLight> light = sensor.pulse;
  light->weather_extinction_per_m = extinction_per_m(*sensor.weather, sensor.wavelength_m);
  return light;
}

ScanWindow scan_window(const Sensor& sensor, std::uint32_t frame) {
  constexpr double kNanoseconds = 1e9;
  const auto start_of = [&](double count) {
    return static_cast<std::int64_t>(std::llround(count * kNanoseconds / sensor.rate_hz));
  };
  return {start_of(frame), start_of(frame + 1.0)};
}

Beams make_beams(const Sensor& sensor, const ScanWindow& window) {
  return std::visit([&](const auto& optics) { return make_beams(optics, window); }, sensor.optics);
}

Beams make_beams(const Sensor& sensor) {
  return make_beams(sensor, scan_window(sensor, 0));
}

}  // namespace glidar
