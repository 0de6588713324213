// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/weather.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/sensor/lidar/precipitation.hpp>

namespace glidar {
namespace {

double kruse_exponent(double visibility_km) {
  if (visibility_km > 50.0) return 1.6;
  if (visibility_km > 6.0) return 1.3;
  return 0.585 * portable_exp(portable_log(visibility_km) / 3.0);
}

double kim_exponent(double visibility_km) {
  if (visibility_km > 6.0) return kruse_exponent(visibility_km);
  if (visibility_km > 1.0) return 0.16 * visibility_km + 0.34;
  return visibility_km > 0.5 ? visibility_km - 0.5 : 0.0;
}

double rain_extinction_per_m(const Weather& weather) {
  if (weather.rain_model == Weather::RainModel::geometric) {
    return geometric_extinction_per_m(rain_sizes(weather.rain_mm_per_h));
  }
  return 0.01 * portable_exp(0.6 * portable_log(weather.rain_mm_per_h));
}

}  // namespace

void validate(const Weather& weather) {
  const auto within = [](double x, double min, double max) { return x >= min && x <= max; };
  require_number(weather.visibility_m == 0.0 || within(weather.visibility_m, 1.0, kMaxVisibility_m),
                 "weather, visibility_m", weather.visibility_m,
                 "metres from 1 to 1e6, or 0 for clear air");
  require_number(within(weather.fog_backscatter_per_sr, 0.0, 1.0),
                 "weather, fog_backscatter_per_sr", weather.fog_backscatter_per_sr,
                 "a number from 0 to 1");
  require_number(weather.fog_looks <= kMaxFogLooks, "weather, fog_looks", weather.fog_looks,
                 "a whole number from 1 to 64, or 0 for echoes that do not vary");
  require_number(within(weather.rain_mm_per_h, 0.0, kMaxFall_mm_per_h), "weather, rain_mm_per_h",
                 weather.rain_mm_per_h, "mm/h from 0 to 1000");
  require_number(within(weather.snow_mm_per_h, 0.0, kMaxFall_mm_per_h), "weather, snow_mm_per_h",
                 weather.snow_mm_per_h, "mm/h from 0 to 1000");
  require_number(within(weather.min_signal, 1e-6, 1e6), "weather, min_signal", weather.min_signal,
                 "a number from 1e-6 to 1e6");
}

double fog_extinction_per_m(const Weather& weather, double wavelength_m) {
  if (!(weather.visibility_m > 0.0)) return 0.0;
  require_number(
      wavelength_m > 0.0, "weather, wavelength_m", wavelength_m,
      "a wavelength above 0 (wavelength_nm in a sensor file): fog's extinction depends on it");
  constexpr double kGreen_m = 550e-9;
  const double visibility_km = weather.visibility_m * 1e-3;
  const double exponent = weather.fog_model == Weather::FogModel::kim
                              ? kim_exponent(visibility_km)
                              : kruse_exponent(visibility_km);
  const double lost = weather.visibility_kind == Weather::Visibility::contrast ? kContrastDepth
                                                                               : kOpticalRangeDepth;
  return lost / weather.visibility_m *
         portable_exp(-exponent * portable_log(wavelength_m / kGreen_m));
}

double extinction_per_m(const Weather& weather, double wavelength_m) {
  double sum = fog_extinction_per_m(weather, wavelength_m);
  if (weather.rain_mm_per_h > 0.0) sum += rain_extinction_per_m(weather);
  if (weather.snow_mm_per_h > 0.0) {
    sum += geometric_extinction_per_m(snow_sizes(weather.snow_mm_per_h, weather.snow_model));
  }
  return sum;
}

void describe(Weather& weather, FieldVisitor& visitor) {
  using W = Weather;
  constexpr std::array<Named<W::Visibility>, 2> kVisibilities = {
      {{"contrast", W::Visibility::contrast}, {"mor", W::Visibility::mor}}};
  constexpr std::array<Named<W::FogModel>, 2> kFogModels = {
      {{"kim", W::FogModel::kim}, {"kruse", W::FogModel::kruse}}};
  constexpr std::array<Named<W::RainModel>, 2> kRainModels = {
      {{"geometric", W::RainModel::geometric}, {"goodin", W::RainModel::goodin}}};
  constexpr std::array<Named<W::SnowModel>, 2> kSnowModels = {
      {{"gunn_marshall", W::SnowModel::gunn_marshall},
       {"sekhon_srivastava", W::SnowModel::sekhon_srivastava}}};
  constexpr NumberRule kVisibility = {0.0, kMaxVisibility_m, false,
                                      "metres from 1 to 1e6, or 0 for clear air"};
  constexpr NumberRule kRate = {0.0, kMaxFall_mm_per_h, false, "mm/h from 0 to 1000"};
  visitor.number({"visibility_m", "in fog or haze; 0: clear air", kUnitMetre}, kVisibility,
                 weather.visibility_m);
  visit_choice(
      visitor,
      {"visibility_kind",
       "distance at which 2 % of contrast remain (ln 50), or meteorological optical range (ln 20)"},
      kVisibilities, weather.visibility_kind);
  visit_choice(visitor, {"fog_model", "how extinction depends on the wavelength"}, kFogModels,
               weather.fog_model);
  visitor.number({"fog_backscatter_per_sr",
                  "backscatter of fog times its meteorological optical range, 1/sr; 0.023 to 0.092 "
                  "are measured"},
                 kZeroToOne, weather.fog_backscatter_per_sr);
  visitor.whole_number({"fog_looks", "echoes of fog vary by 1 / sqrt(looks); 0: not at all"},
                       {0, kMaxFogLooks}, weather.fog_looks);
  visitor.number({"rain_mm_per_h", "rain", {"mm/h"}}, kRate, weather.rain_mm_per_h);
  visit_choice(visitor, {"rain_model", "extinction of rain"}, kRainModels, weather.rain_model);
  visitor.number({"snow_mm_per_h", "snow, as melted water", {"mm/h"}}, kRate,
                 weather.snow_mm_per_h);
  visit_choice(visitor, {"snow_model", "sizes of snowflakes"}, kSnowModels, weather.snow_model);
  visitor.number({"min_signal", "echoes of the air below this share of the threshold are ignored"},
                 {1e-6, 1e6, false, "a number from 1e-6 to 1e6"}, weather.min_signal);
  if (!visitor.is_reading()) return;
  if (weather.visibility_m > 0.0 && weather.visibility_m < 1.0)
    visitor.reject("visibility_m", "{}", kVisibility.allowed);
  validate(weather);
}

}  // namespace glidar
