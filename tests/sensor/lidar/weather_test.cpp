// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/weather.hpp>

#include <glidar/core/error.hpp>
#include <glidar/sensor/lidar/precipitation.hpp>
#include <glidar/sensor/sensor.hpp>

#include <gtest/gtest.h>
#include <support/error_text.hpp>
#include <support/parameter_name.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace glidar {
namespace {

using FogModel = Weather::FogModel;

double fog_per_km(double visibility_km, double wavelength_nm, FogModel model) {
  const Weather weather{.visibility_m = 1e3 * visibility_km, .fog_model = model};
  return 1e3 * fog_extinction_per_m(weather, 1e-9 * wavelength_nm);
}

struct FogRow {
  double visibility_km;
  FogModel model;
  double at_905_per_km;
  double at_1550_per_km;
  double last_digit;
};

void PrintTo(const FogRow& row, std::ostream* out) {
  *out << (row.model == FogModel::kim ? "Kim" : "Kruse") << ", visibility " << row.visibility_km
       << " km";
}

class FogTable : public ::testing::TestWithParam<FogRow> {};

TEST_P(FogTable, ReproducesThePublishedExtinction) {
  const FogRow& row = GetParam();
  const double half = 0.51 * row.last_digit;
  EXPECT_NEAR(fog_per_km(row.visibility_km, 905.0, row.model), row.at_905_per_km, half);
  EXPECT_NEAR(fog_per_km(row.visibility_km, 1550.0, row.model), row.at_1550_per_km, half);
}

INSTANTIATE_TEST_SUITE_P(Fog, FogTable,
                         ::testing::Values(FogRow{0.2, FogModel::kim, 19.56, 19.56, 0.01},
                                           FogRow{0.2, FogModel::kruse, 16.50, 13.72, 0.01},
                                           FogRow{1.0, FogModel::kim, 3.050, 2.330, 0.001},
                                           FogRow{1.0, FogModel::kruse, 2.923, 2.134, 0.001},
                                           FogRow{5.0, FogModel::kim, 0.443, 0.240, 0.001},
                                           FogRow{5.0, FogModel::kruse, 0.475, 0.278, 0.001},
                                           FogRow{10.0, FogModel::kim, 0.205, 0.102, 0.001},
                                           FogRow{10.0, FogModel::kruse, 0.205, 0.102, 0.001},
                                           FogRow{23.0, FogModel::kim, 0.089, 0.044, 0.001}),
                         testing::parameter_name<FogRow>);

TEST(Fog, HasThePublishedTwoWayTransmissionOver100Metres) {
  const std::vector<std::array<double, 2>> table = {
      {0.2, 0.0200}, {0.5, 0.2091}, {1.0, 0.5434}, {2.0, 0.7546}, {10.0, 0.9599}};
  for (const auto& [visibility_km, left] : table) {
    const double alpha_per_m = 1e-3 * fog_per_km(visibility_km, 905.0, FogModel::kim);
    EXPECT_NEAR(std::exp(-2.0 * alpha_per_m * 100.0), left, 5.1e-5);
  }
}

TEST(Fog, ChangesItsExponentAtTheLimitsOfTheModels) {
  const double above = std::pow(905.0 / 550.0, -1.6);
  const double below = std::pow(905.0 / 550.0, -1.3);
  for (const FogModel model : {FogModel::kim, FogModel::kruse}) {
    EXPECT_NEAR(fog_per_km(50.1, 905.0, model), 3.912 / 50.1 * above, 1e-12);
    EXPECT_NEAR(fog_per_km(50.0, 905.0, model), 3.912 / 50.0 * below, 1e-12);
  }
  const double at_6_km = 3.912 / 6.0 * std::pow(905.0 / 550.0, -0.585 * std::cbrt(6.0));
  EXPECT_NEAR(fog_per_km(6.0, 905.0, FogModel::kruse), at_6_km, 1e-12);
  // Kim's pieces join
  EXPECT_NEAR(fog_per_km(6.0 + 1e-9, 905.0, FogModel::kim), fog_per_km(6.0, 905.0, FogModel::kim),
              1e-8);
  EXPECT_NEAR(fog_per_km(0.5 + 1e-9, 905.0, FogModel::kim), fog_per_km(0.5, 905.0, FogModel::kim),
              1e-6);
}

TEST(Fog, HasTwoPercentContrastOrFivePercentTransmissionAtTheVisibility) {
  const Weather contrast{.visibility_m = 300.0};
  const Weather range{.visibility_m = 300.0, .visibility_kind = Weather::Visibility::mor};
  EXPECT_NEAR(std::exp(-300.0 * fog_extinction_per_m(contrast, 550e-9)), 0.02, 1e-6);
  EXPECT_NEAR(std::exp(-300.0 * fog_extinction_per_m(range, 550e-9)), 0.05, 1e-12);
}

TEST(Fog, RequiresAWavelength) {
  EXPECT_EQ(fog_extinction_per_m({}, 0.0), 0.0);
  EXPECT_EQ(error_text([] { fog_extinction_per_m({.visibility_m = 100.0}, 0.0); }),
            "weather, wavelength_m: 0; allowed: a wavelength above 0 (wavelength_nm in a sensor "
            "file): fog's extinction depends on it");
}

TEST(Rain, HasThePublishedDropNumbersAndExtinctions) {
  struct Row {
    double mm_per_h, drops_per_m3, geometric_per_m, goodin_per_m;
  };
  for (const Row& row : {Row{1.0, 1590.0, 0.00036, 0.010}, Row{10.0, 2789.0, 0.00156, 0.040},
                         Row{50.0, 4055.0, 0.00429, 0.105}, Row{100.0, 4747.0, 0.00664, 0.158}}) {
    EXPECT_NEAR(drops_per_m3(rain_sizes(row.mm_per_h), 5e-5), row.drops_per_m3, 0.51);
    Weather rain{.rain_mm_per_h = row.mm_per_h};
    EXPECT_NEAR(extinction_per_m(rain, 0.0), row.geometric_per_m, 0.51e-5);
    rain.rain_model = Weather::RainModel::goodin;
    EXPECT_NEAR(extinction_per_m(rain, 0.0), row.goodin_per_m, 0.51e-3);
  }
}

/// By the midpoint rule, from the published spectra in millimetres.
double summed_extinction_per_m(double number, double slope_per_mm) {
  double area_mm2 = 0.0;
  constexpr double kStep_mm = 1e-4;
  for (double d = 0.5 * kStep_mm; d < 40.0; d += kStep_mm) {
    area_mm2 += 0.25 * std::numbers::pi * d * d * number * std::exp(-slope_per_mm * d) * kStep_mm;
  }
  return 2.0 * area_mm2 * 1e-6;
}

TEST(Snow, HasTwiceItsCrossSectionsAsExtinction) {
  Weather snow{.snow_mm_per_h = 2.0};
  EXPECT_NEAR(extinction_per_m(snow, 0.0) / summed_extinction_per_m(7600.0 * std::pow(2.0, -0.87),
                                                                    2.55 * std::pow(2.0, -0.48)),
              1.0, 1e-6);
  snow.snow_model = Weather::SnowModel::sekhon_srivastava;
  EXPECT_NEAR(extinction_per_m(snow, 0.0) / summed_extinction_per_m(2500.0 * std::pow(2.0, -0.94),
                                                                    2.29 * std::pow(2.0, -0.45)),
              1.0, 1e-6);
}

TEST(Weather, AddsTheExtinctionsOfFogRainAndSnow) {
  const Weather fog{.visibility_m = 500.0};
  const Weather rain{.rain_mm_per_h = 5.0};
  const Weather snow{.snow_mm_per_h = 1.0};
  const Weather all{.visibility_m = 500.0, .rain_mm_per_h = 5.0, .snow_mm_per_h = 1.0};
  EXPECT_DOUBLE_EQ(extinction_per_m(all, 905e-9), extinction_per_m(fog, 905e-9) +
                                                      extinction_per_m(rain, 905e-9) +
                                                      extinction_per_m(snow, 905e-9));
  EXPECT_EQ(extinction_per_m({}, 905e-9), 0.0);
}

TEST(Weather, RequiresALidarEquationAndAWavelength) {
  Sensor sensor;
  EXPECT_NO_THROW(check_weather(sensor));
  sensor.lidar_equation = LidarEquation{};
  sensor.weather = Weather{.rain_mm_per_h = 10.0};
  EXPECT_NO_THROW(check_weather(sensor));
  sensor.weather->visibility_m = 100.0;
  EXPECT_THROW(check_weather(sensor), Error);
  sensor.wavelength_m = 905e-9;
  EXPECT_NO_THROW(check_weather(sensor));
}

TEST(Weather, IsAnErrorWithoutALidarEquation) {
  Sensor sensor;
  sensor.weather = Weather{};
  EXPECT_EQ(error_text([&] { check_weather(sensor); }),
            "weather: the sensor 'depth camera' has no lidar_equation; allowed: weather for a "
            "sensor with 'lidar_equation'; add 'lidar_equation' to a sensor file (docs/files.md)");
}

TEST(Weather, RejectsInvalidNumbers) {
  EXPECT_NO_THROW(validate(Weather{}));
  EXPECT_THROW(validate(Weather{.visibility_m = -1.0}), Error);
  EXPECT_THROW(validate(Weather{.visibility_m = 0.5}), Error);
  EXPECT_THROW(validate(Weather{.visibility_m = std::nan("")}), Error);
  EXPECT_THROW(validate(Weather{.fog_backscatter_per_sr = -0.1}), Error);
  EXPECT_THROW(validate(Weather{.snow_mm_per_h = -2.0}), Error);
  EXPECT_THROW(validate(Weather{.min_signal = 0.0}), Error);
  EXPECT_EQ(error_text([] { validate(Weather{.rain_mm_per_h = 2e3}); }),
            "weather, rain_mm_per_h: 2000; allowed: mm/h from 0 to 1000");
}

}  // namespace
}  // namespace glidar
