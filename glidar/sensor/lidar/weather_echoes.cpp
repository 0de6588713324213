// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/weather_echoes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace glidar {
namespace {

constexpr double kBlindRange_m = 0.9;
constexpr double kFullOverlap_m = 1.0;

bool defines_near_range(const LidarEquation& light) {
  if (light.overlap.empty()) return false;
  const auto [range_m, share] = light.overlap.front();
  return range_m > 0.0 && share == 0.0;
}

}  // namespace

double min_visible_range_m(const LidarEquation& light) {
  return defines_near_range(light) ? light.overlap.front()[0] : kBlindRange_m;
}

double crossover(const LidarEquation& light, double range_m) {
  if (defines_near_range(light)) return 1.0;
  return std::clamp((range_m - kBlindRange_m) / (kFullOverlap_m - kBlindRange_m), 0.0, 1.0);
}

double weather_signal(const LidarEquation& light, double backscatter, double range_m) {
  return received_signal(light, backscatter, range_m) * crossover(light, range_m);
}

namespace {

constexpr std::uint32_t kSnowBlocks = 1U << 23U;  // first of snow; rain begins at 0

}  // namespace

PreparedWeather prepare_weather(const Weather& weather, const LidarEquation& light,
                                double wavelength_m, const BeamShape& beam, double pulse_fwhm_s) {
  PreparedWeather prepared{.light = light, .min_signal = weather.min_signal};
  prepared.light.weather_extinction_per_m = extinction_per_m(weather, wavelength_m);
  const double optical_depth_per_m = fog_extinction_per_m(weather, wavelength_m);
  const double backscatter_per_m_sr =
      weather.fog_backscatter_per_sr * optical_depth_per_m / kOpticalRangeDepth;
  if (weather.fog_looks > 0) {
    prepared.varying_fog =
        varying_fog(prepared.light, backscatter_per_m_sr, pulse_fwhm_s, weather.fog_looks);
  } else {
    prepared.fog = fog_return(prepared.light, backscatter_per_m_sr, pulse_fwhm_s);
  }
  if (weather.rain_mm_per_h > 0.0) {
    prepared.rain =
        drop_field(prepared.light, rain_sizes(weather.rain_mm_per_h), beam, weather.min_signal);
  }
  if (weather.snow_mm_per_h > 0.0) {
    prepared.snow =
        drop_field(prepared.light, snow_sizes(weather.snow_mm_per_h, weather.snow_model), beam,
                   weather.min_signal);
  }
  return prepared;
}

void weather_echoes(const PreparedWeather& weather, double hard_range_m, const RngKey& key,
                    std::vector<WeatherEcho>& echoes) {
  const double end_m =
      std::isnan(hard_range_m) ? std::numeric_limits<double>::infinity() : hard_range_m;
  const SoftEcho soft = weather.varying_fog.looks > 0 ? echo_before(weather.varying_fog, end_m, key)
                                                      : echo_before(weather.fog, end_m);
  if (soft.signal >= weather.min_signal) {
    echoes.push_back({soft.range_m, soft.signal, ReturnSource::fog});
  }
  RngKey drops = key;
  drops.purpose = Purpose::weather;
  const auto append = [&](const DropField& field, std::uint32_t block, ReturnSource source) {
    drops.block = block;
    const auto take = [&](const DropEcho& drop) {
      echoes.push_back({drop.range_m, drop.signal, source});
    };
    sample_drops(weather.light, field, end_m, drops, FunctionRef<void(const DropEcho&)>(take));
  };
  append(weather.rain, 0, ReturnSource::rain);
  append(weather.snow, kSnowBlocks, ReturnSource::snow);
}

}  // namespace glidar
