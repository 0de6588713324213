// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Weather from the sensor to the frame.
#include <glidar/core/error.hpp>
#include <glidar/io/builtin_models.hpp>
#include <glidar/simulate.hpp>
#include <support/data.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

/// A pulsed camera so far before a plane.
Frame shoot(const std::optional<PulseLight>& pulse, const std::optional<Weather>& weather,
            double distance_m, const std::optional<Footprint>& footprint = {}) {
  const Scene scene = testing::scene_of(make_builtin_model("plane"));
  Sensor sensor;
  sensor.optics = pinhole_from_fov(9, 7, 0.01);
  sensor.wavelength_m = 905e-9;
  sensor.pulse = pulse;
  sensor.weather = weather;
  sensor.footprint = footprint;
  const Beams beams = make_beams(sensor);
  const Motion motion =
      standing_still(scene, look_at({0.0, 0.0, distance_m}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}));
  const auto renderer = make_renderer(scene, {.threads = 1});
  Frame frame;
  simulate({scene, sensor, beams, motion, *renderer}, {}, frame);
  return frame;
}

TEST(WeatherInAFrame, DimsEveryBeamByTheWayThereAndBack) {
  const PulseLight light{.reference_range_m = 1000.0};
  const Weather fog{.visibility_m = 1000.0, .rain_mm_per_h = 10.0};
  const double alpha_per_m = 3.050e-3 + 1.556e-3;  // Kim's, and Marshall and Palmer's drops
  const Frame clear = shoot(light, {}, 100.0);
  const Frame foggy = shoot(light, fog, 100.0);
  ASSERT_EQ(clear.status.size(), 63U);
  for (std::size_t i = 0; i < clear.status.size(); ++i) {
    ASSERT_EQ(foggy.status[i], Status::hit);
    EXPECT_EQ(foggy.range_m[i], clear.range_m[i]);
    EXPECT_NEAR(foggy.intensity[i] / clear.intensity[i],
                std::exp(-2.0 * alpha_per_m * clear.truth.range_m[i]), 2e-4);
  }
}

TEST(WeatherInAFrame, DimsPulsesWithAFootprintToo) {
  const PulseLight light{.reference_range_m = 1000.0};
  const Footprint footprint{.divergence_x_rad = 1e-4, .divergence_y_rad = 1e-4};
  const Frame clear = shoot(light, {}, 100.0, footprint);
  const Frame foggy = shoot(light, Weather{.visibility_m = 1000.0}, 100.0, footprint);
  const Frame dense = shoot(light, Weather{.visibility_m = 50.0}, 100.0, footprint);
  for (std::size_t i = 0; i < clear.status.size(); ++i) {
    ASSERT_EQ(foggy.status[i], Status::hit);
    EXPECT_NEAR(foggy.intensity[i] / clear.intensity[i], 0.5434, 1e-4);  // Kim's, at 905 nm
    EXPECT_EQ(dense.status[i], Status::weather);
  }
}

TEST(WeatherInAFrame, TakesReturnsAndSaysSo) {
  const PulseLight light{.reference_reflectance = 0.01, .reference_range_m = 200.0};
  const Frame clear = shoot(light, {}, 100.0);
  const Frame foggy = shoot(light, Weather{.visibility_m = 60.0}, 100.0);
  const auto all = [](const Frame& frame, Status status) {
    return std::all_of(frame.status.begin(), frame.status.end(),
                       [&](Status found) { return found == status; });
  };
  EXPECT_TRUE(all(clear, Status::hit));
  EXPECT_TRUE(all(foggy, Status::weather));
  EXPECT_NEAR(foggy.truth.range_m[31], 100.0, 1e-9);
}

TEST(WeatherInAFrame, IsRefusedForLightThatIsNotPulsed) {
  EXPECT_THROW(shoot({}, Weather{.rain_mm_per_h = 5.0}, 10.0), Error);
}

}  // namespace
}  // namespace glidar
