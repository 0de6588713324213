// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/weather_echoes.hpp>

#include <glidar/core/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

namespace glidar {
namespace {

constexpr double kNoTarget = std::numeric_limits<double>::infinity();
constexpr BeamShape kBeam = {.divergence_rad = 0.003, .exit_diameter_m = 0.0095};
const Weather kSleet = {
    .visibility_m = 100.0, .rain_mm_per_h = 60.0, .snow_mm_per_h = 4.0, .min_signal = 0.01};

PreparedWeather prepare(const Weather& weather) {
  return prepare_weather(weather, {.reference_range_m = 100.0}, 905e-9, kBeam, 5e-9);
}

std::vector<WeatherEcho> echoes_of(const PreparedWeather& weather, double hard_range_m,
                                   RngKey draw) {
  std::vector<WeatherEcho> echoes;
  weather_echoes(weather, hard_range_m, draw, echoes);
  return echoes;
}

bool equal(const std::vector<WeatherEcho>& one, const std::vector<WeatherEcho>& other) {
  return std::equal(one.begin(), one.end(), other.begin(), other.end(),
                    [](const WeatherEcho& a, const WeatherEcho& b) {
                      return a.range_m == b.range_m && a.signal == b.signal &&
                             a.return_source == b.return_source;
                    });
}

std::map<ReturnSource, std::size_t> count(const PreparedWeather& weather, std::uint32_t beams) {
  std::map<ReturnSource, std::size_t> counts;
  for (std::uint32_t beam = 0; beam < beams; ++beam) {
    for (const WeatherEcho& echo : echoes_of(weather, kNoTarget, {.seed = 3, .beam = beam})) {
      ++counts[echo.return_source];
      EXPECT_GE(echo.signal, weather.min_signal);
      EXPECT_GE(echo.range_m, 0.9);
    }
  }
  return counts;
}

TEST(WeatherEchoes, HaveTheSourcesOfTheWeather) {
  auto all = count(prepare(kSleet), 500);
  EXPECT_EQ(all[ReturnSource::fog], 500U);
  EXPECT_GT(all[ReturnSource::rain], 20U);
  EXPECT_GT(all[ReturnSource::snow], 20U);
  Weather rain = kSleet;
  rain.visibility_m = 0.0;
  rain.snow_mm_per_h = 0.0;
  auto only_rain = count(prepare(rain), 500);
  EXPECT_EQ(only_rain[ReturnSource::fog], 0U);
  EXPECT_GT(only_rain[ReturnSource::rain], 20U);
  EXPECT_EQ(only_rain[ReturnSource::snow], 0U);
  EXPECT_TRUE(echoes_of(prepare({}), kNoTarget, {}).empty());
}

TEST(WeatherEchoes, DependOnSeedSensorFrameAndBeamOnly) {
  const PreparedWeather weather = prepare(kSleet);
  const RngKey draw{.seed = 9, .sensor = 2, .frame = 7, .beam = 40};
  const auto expected = echoes_of(weather, 80.0, draw);
  RngKey other = draw;
  other.purpose = Purpose::detection;
  other.block = 17;
  EXPECT_TRUE(equal(echoes_of(weather, 80.0, other), expected));
  const auto differs = [&](auto RngKey::*member) {
    // one beam may have no drops, but not twenty
    bool is_other = false;
    for (std::uint32_t beam = 0; beam < 20; ++beam) {
      RngKey one = draw;
      one.beam = 100 + beam;
      RngKey two = one;
      two.*member = 1000 + beam;
      is_other = is_other || !equal(echoes_of(weather, 80.0, one), echoes_of(weather, 80.0, two));
    }
    return is_other;
  };
  EXPECT_TRUE(differs(&RngKey::seed));
  EXPECT_TRUE(differs(&RngKey::sensor));
  EXPECT_TRUE(differs(&RngKey::frame));
  EXPECT_TRUE(differs(&RngKey::beam));
}

TEST(WeatherEchoes, OfFogRelativeToTargetsMatchTheTheory) {
  // Rasshofer et al.: soft over hard = R0^2 exp(2 alpha R0) pi beta / rho (c / 2) I_s
  const double alpha = 0.06;
  const Weather fog{.visibility_m = std::log(20.0) / alpha,
                    .visibility_kind = Weather::Visibility::mor,
                    .fog_looks = 0};
  const LidarEquation light{.reference_reflectance = 0.1, .reference_range_m = 55.0};
  const PreparedWeather weather = prepare_weather(fog, light, 550e-9, {}, 20e-9);
  EXPECT_NEAR(weather.light.weather_extinction_per_m, alpha, 1e-12);
  const auto echoes = echoes_of(weather, 30.0, {});
  ASSERT_EQ(echoes.size(), 1U);
  const double beta = 0.046 * alpha / std::log(20.0);
  const double ratio = 30.0 * 30.0 * std::exp(2.0 * alpha * 30.0) * std::numbers::pi * beta / 0.5 *
                       0.5 * 299792458.0 * 3.815421e-9;
  const double hard = received_signal(weather.light, 0.5, 30.0);
  EXPECT_NEAR(echoes[0].signal / hard, ratio, 1e-3 * ratio);  // the sum samples every 0.1 m
  EXPECT_NEAR(echoes[0].range_m, 4.6 - 2.998, 0.05);
}

TEST(WeatherEchoes, OfFogVaryBetweenBeamsUnlessLooksIsZero) {
  for (const unsigned looks : {0U, 1U, 16U}) {
    const PreparedWeather weather = prepare({.visibility_m = 100.0, .fog_looks = looks});
    const auto one = echoes_of(weather, 50.0, {.beam = 1});
    const auto other = echoes_of(weather, 50.0, {.beam = 2});
    ASSERT_EQ(one.size(), 1U);
    ASSERT_EQ(other.size(), 1U);
    EXPECT_EQ(one[0].signal == other[0].signal, looks == 0);
    EXPECT_EQ(one[0].range_m == other[0].range_m, looks == 0);
  }
}

TEST(WeatherEchoes, AreNearerThanTheTarget) {
  const PreparedWeather weather = prepare(kSleet);
  for (std::uint32_t beam = 0; beam < 300; ++beam) {
    for (const WeatherEcho& echo : echoes_of(weather, 2.0, {.beam = beam})) {
      EXPECT_LT(echo.range_m, 2.0);
    }
    EXPECT_TRUE(equal(echoes_of(weather, std::nan(""), {.beam = beam}),
                      echoes_of(weather, kNoTarget, {.beam = beam})));
  }
}

TEST(WeatherEchoes, AreAppended) {
  std::vector<WeatherEcho> echoes(3);
  weather_echoes(prepare({.visibility_m = 50.0}), 40.0, {}, echoes);
  EXPECT_EQ(echoes.size(), 4U);
}

TEST(WeatherEchoes, RequireAWavelengthInFog) {
  EXPECT_THROW(prepare_weather({.visibility_m = 50.0}, {}, 0.0, {}, 5e-9), Error);
  EXPECT_NO_THROW(prepare_weather({.rain_mm_per_h = 5.0}, {}, 0.0, {}, 5e-9));
}

TEST(WeatherEchoes, HaveTheGoldenValues) {
  // Golden values: they must never change for a seed.
  const auto echoes =
      echoes_of(prepare(kSleet), kNoTarget, {.seed = 12345, .sensor = 1, .frame = 2, .beam = 0});
  const std::vector<WeatherEcho> expected = {
      {1.7814477182717623, 11.488477875333265, ReturnSource::fog},
      {1.3289356016872833, 0.83749481095279321, ReturnSource::rain},
      {3.1822653663684171, 0.035858706483975988, ReturnSource::rain},
      {1.1855792560211114, 0.10846807749981079, ReturnSource::snow}};
  EXPECT_TRUE(equal(echoes, expected));
}

}  // namespace
}  // namespace glidar
