// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_document.hpp>

#include <glidar/io/config/exact_unit.hpp>
#include <glidar/io/config/noise_yaml.hpp>
#include <glidar/io/config/optics_document.hpp>
#include <glidar/io/config/receiver_yaml.hpp>
#include <glidar/io/config/weather_yaml.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace glidar {
namespace {

using Json = nlohmann::ordered_json;

Json limits_document(const Limits& limits) {
  Json told = {{"near_m", limits.near_m}};
  if (std::isfinite(limits.far_m)) told["far_m"] = limits.far_m;
  told["along"] = limits.along == Limits::Along::depth ? "depth" : "range";
  return told;
}

Json light_document(const PhongHeadlight& light) {
  return {{"attenuation",
           {{"constant", light.attenuation_constant},
            {"linear_per_m", light.attenuation_linear_per_m},
            {"quadratic_per_m2", light.attenuation_quadratic_per_m2}}},
          {"ambient", light.ambient}};
}

Json pulse_document(const LidarEquation& light) {
  Json told = {{"reference_reflectance", light.reference_reflectance},
               {"reference_range_m", light.reference_range_m},
               {"range_exponent", light.range_exponent},
               {"extinction_per_m", light.extinction_per_m},
               {"noise_sigma", light.noise_sigma},
               {"saturation", light.saturation}};
  if (!light.overlap.empty()) told["overlap"] = light.overlap;
  return told;
}

/// Widths at 1/e^2, or at half maximum where only those give the numbers exactly.
Json footprint_document(const Footprint& f) {
  constexpr double kMilliPerUnit = 1e-3;
  const std::array<double, 4> widths = {f.divergence_x_rad, f.divergence_y_rad, f.exit_x_m,
                                        f.exit_y_m};
  const bool is_fwhm = !std::all_of(widths.begin(), widths.end(), [](double width) {
    return find_exact_in(width, kMilliPerUnit).has_value();
  });
  const double unit = is_fwhm ? kMilliPerUnit * kWidthPerFwhm : kMilliPerUnit;
  return {{"divergence_mrad", {exact_in(widths[0], unit), exact_in(widths[1], unit)}},
          {"exit_mm", {exact_in(widths[2], unit), exact_in(widths[3], unit)}},
          {"width_definition", is_fwhm ? "fwhm" : "1/e2"},
          {"rings", f.rings}};
}

/// The names of the returns, or how many of the nearest.
Json returns_document(const std::vector<Return>& returns) {
  const auto same = [](const Return& a, const Return& b) {
    return a.order == b.order && a.rank == b.rank;
  };
  const std::vector<Return> nearest = nearest_returns(static_cast<std::uint32_t>(returns.size()));
  if (std::equal(returns.begin(), returns.end(), nearest.begin(), same)) return returns.size();
  Json names = Json::array();
  for (const Return& one : returns) names.push_back(return_name(one));
  return names;
}

Json receiver_document(const Receiver& receiver) {
  constexpr double kNanoPerUnit = 1e-9;
  const bool is_centroid = receiver.timing == Receiver::Timing::centroid;
  return {{"pulse_ns", exact_in(receiver.pulse_fwhm_s, kNanoPerUnit)},
          {"timing", is_centroid ? "centroid" : "leading_edge"},
          {"min_return_separation_m", receiver.separation_m},
          {"returns", returns_document(receiver.returns)}};
}

/// Leaves out what is infinite or empty: only a default is, and no file can spell it.
Json noise_document(const std::vector<NoiseStep>& noise) {
  Json list = Json::array();
  for (const Json& step : noise_json(noise, exact_in)) {
    Json kept = Json::object();
    for (const auto& [key, value] : step.items()) {
      const bool is_infinite = value.is_number_float() && !std::isfinite(value.get<double>());
      if (!is_infinite && !(value.is_array() && value.empty())) kept[key] = value;
    }
    list.push_back(kept);
  }
  return list;
}

void add_pulse_parts(const Sensor& sensor, Json& told) {
  told["lidar_equation"] = pulse_document(*sensor.pulse);
  if (sensor.footprint) told["footprint"] = footprint_document(*sensor.footprint);
  told["receiver"] = receiver_document(sensor.receiver);
  if (sensor.weather) told["weather"] = weather_json(*sensor.weather);
}

}  // namespace

std::string sensor_document(const Sensor& sensor) {
  constexpr double kNanometre_m = 1e-9;
  Json told = {{"name", sensor.name}};
  if (Json optics = optics_document(sensor.optics); !optics.is_null()) told["optics"] = optics;
  told["rate_hz"] = sensor.rate_hz;
  if (sensor.wavelength_m > 0.0) {
    told["wavelength_nm"] = exact_in(sensor.wavelength_m, kNanometre_m);
  }
  told["limits"] = limits_document(sensor.limits);
  if (sensor.pulse) {
    add_pulse_parts(sensor, told);
  } else {
    told["light"] = light_document(sensor.light);
  }
  if (sensor.projector_origin_m) {
    const Eigen::Vector3d& p = *sensor.projector_origin_m;
    told["projector_origin_m"] = {p.x(), p.y(), p.z()};
  }
  told["noise"] = noise_document(sensor.noise);
  told["cull_back_faces"] = sensor.cull_back_faces;
  return told.dump();
}

}  // namespace glidar
