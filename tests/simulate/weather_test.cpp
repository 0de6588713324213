// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Weather from the sensor to the frame.
#include <glidar/core/error.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <support/data.hpp>
#include <support/simulate.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

/// Fog of this visibility without backscatter.
Weather dark_fog(double visibility_m) {
  return {.visibility_m = visibility_m, .fog_backscatter_per_sr = 0.0};
}

/// A pulsed camera at this distance from a plane.
Frame shoot(const std::optional<LidarEquation>& pulse, const std::optional<Weather>& weather,
            double distance_m, const std::optional<Footprint>& footprint = {}) {
  const Scene scene = testing::scene_of(make_builtin_model("plane"));
  Sensor sensor;
  sensor.optics = pinhole_from_fov(9, 7, 0.01);
  sensor.wavelength_m = 905e-9;
  sensor.lidar_equation = pulse;
  sensor.weather = weather;
  sensor.footprint = footprint;
  const Beams beams = make_beams(sensor);
  const Motion motion =
      static_motion(scene, look_at({0.0, 0.0, distance_m}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}));
  const auto renderer = make_renderer(scene, {.threads = 1});
  Frame frame;
  testing::simulate({scene, sensor, beams, motion, *renderer}, {}, frame);
  return frame;
}

TEST(WeatherInAFrame, AttenuatesEveryBeamByTheTwoWayTransmission) {
  const LidarEquation light{.reference_range_m = 1000.0};
  Weather fog = dark_fog(1000.0);
  fog.rain_mm_per_h = 10.0;
  fog.min_signal = 1e6;                            // echoes of drops have their own tests
  const double alpha_per_m = 3.050e-3 + 1.556e-3;  // Kim's, and Marshall and Palmer's drops
  const Frame clear = shoot(light, {}, 100.0);
  const Frame foggy = shoot(light, fog, 100.0);
  ASSERT_EQ(clear.status.size(), 63U);
  for (std::size_t i = 0; i < clear.status.size(); ++i) {
    ASSERT_EQ(foggy.status[i], Status::hit);
    EXPECT_EQ(foggy.range_m[i], clear.range_m[i]);
    EXPECT_NEAR(foggy.intensity[i] / clear.intensity[i],
                std::exp(-2.0 * alpha_per_m * clear.ground_truth.range_m[i]), 2e-4);
  }
}

TEST(WeatherInAFrame, AttenuatesPulsesWithAFootprint) {
  const LidarEquation light{.reference_range_m = 1000.0};
  const Footprint footprint{.divergence_x_rad = 1e-4, .divergence_y_rad = 1e-4};
  const Frame clear = shoot(light, {}, 100.0, footprint);
  const Frame foggy = shoot(light, dark_fog(1000.0), 100.0, footprint);
  const Frame dense = shoot(light, dark_fog(50.0), 100.0, footprint);
  for (std::size_t i = 0; i < clear.status.size(); ++i) {
    ASSERT_EQ(foggy.status[i], Status::hit);
    EXPECT_NEAR(foggy.intensity[i] / clear.intensity[i], 0.5434, 1e-4);  // Kim's, at 905 nm
    EXPECT_EQ(dense.status[i], Status::weather);
  }
}

TEST(WeatherInAFrame, RemovesReturnsWithTheStatusWeather) {
  const LidarEquation light{.reference_reflectance = 0.01, .reference_range_m = 200.0};
  const Frame clear = shoot(light, {}, 100.0);
  const Frame foggy = shoot(light, dark_fog(60.0), 100.0);
  const auto all = [](const Frame& frame, Status status) {
    return std::all_of(frame.status.begin(), frame.status.end(),
                       [&](Status found) { return found == status; });
  };
  EXPECT_TRUE(all(clear, Status::hit));
  EXPECT_TRUE(all(foggy, Status::weather));
  EXPECT_NEAR(foggy.ground_truth.range_m[31], 100.0, 1e-9);
}

TEST(WeatherInAFrame, FogInFrontOfAFaintTargetIsReportedInstead) {
  const LidarEquation light{.reference_range_m = 1000.0, .overlap = {{0.9, 0.0}, {1.0, 1.0}}};
  const Weather fog{.visibility_m = 100.0};
  const Frame frame = shoot(light, fog, 100.0);
  for (std::size_t i = 0; i < frame.status.size(); ++i) {
    ASSERT_EQ(frame.status[i], Status::hit);
    EXPECT_EQ(frame.return_source[i], ReturnSource::fog);
    EXPECT_LT(frame.range_m[i], 5.0);
    EXPECT_NEAR(frame.ground_truth.range_m[i], 100.0, 0.01) << "the ground truth is the plane";
  }
}

TEST(WeatherInAFrame, DropsAreReportedWithoutASurface) {
  const LidarEquation light{.reference_range_m = 1000.0};
  const Footprint footprint{.divergence_x_rad = 3e-3, .divergence_y_rad = 3e-3};
  // the plane is 2 m wide and 3 km away: the beams' edges see past it
  const Frame snow = shoot(light, Weather{.snow_mm_per_h = 20.0}, 3000.0, footprint);
  std::size_t flakes = 0;
  for (std::size_t i = 0; i < snow.status.size(); ++i) {
    if (snow.return_source[i] != ReturnSource::snow) continue;
    ++flakes;
    EXPECT_GT(snow.range_m[i], 0.0);
    EXPECT_LT(snow.range_m[i], 3000.0);
    EXPECT_GE(snow.intensity[i], 1.0F);
  }
  EXPECT_GT(flakes, 0U);
  EXPECT_EQ(std::count(snow.return_source.begin(), snow.return_source.end(), ReturnSource::rain),
            0);
}

TEST(WeatherInAFrame, IsAnErrorWithoutALidarEquation) {
  EXPECT_THROW(shoot({}, Weather{.rain_mm_per_h = 5.0}, 10.0), Error);
}

}  // namespace
}  // namespace glidar
