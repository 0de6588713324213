// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_options.hpp>
#include <glidar/math/constants.hpp>
#include "io/yaml_files.hpp"

#include <gtest/gtest.h>
#include <support/preset.hpp>

#include <limits>

namespace glidar {
namespace {

TEST(NoiseText, IsTheNameAndNumbersOfASensorFile) {
  EXPECT_EQ(noise_text(RangeGaussian{.sigma_m = 0.03}),
            "range_gaussian sigma_m 0.03, sigma_per_m 0.0");
  EXPECT_EQ(noise_text(Dropout{.probability = 0.25, .by_range_m = {{1.0, 0.5}}}),
            "dropout probability 0.25, by_range_m [[1.0,0.5]], by_incidence_deg []");
  EXPECT_EQ(noise_text(IntensityScale{}).substr(0, 16), "intensity_scale ");
}

}  // namespace

namespace {

using testing::preset;

/// All options, as Python applies them.
Sensor with(Sensor sensor, const SensorOptions& options) {
  apply_scan(options, {}, sensor);
  apply_weather(options, {}, sensor);
  apply_returns(options, {}, sensor);
  return sensor;
}

/// The error when only one option is given.
template <class Value, class Given>
std::string error_with(const std::string& name, Value SensorOptions::*option, Given value) {
  SensorOptions options;
  options.*option = value;
  const TestFolder folder;
  return error_of(folder, [&] { with(preset(name), options); });
}

TEST(SensorOptions, SetWhatTheyNameAndNothingElse) {
  const Sensor sensor = with(preset("VLP-16"), {.calibration_files = {},
                                                .rate_hz = 20.0,
                                                .columns_per_turn = 900,
                                                .depth_model = {},
                                                .returns = parse_returns("", {"strongest", "last"}),
                                                .visibility_m = 100.0,
                                                .rain_mm_per_h = 5.0,
                                                .snow_mm_per_h = 0.5});
  const auto& spinning = std::get<Spinning>(sensor.optics);
  EXPECT_EQ(sensor.rate_hz, 20.0);
  EXPECT_EQ(spinning.rotation_hz, 20.0);
  EXPECT_EQ(spinning.columns_per_turn, 900U);
  EXPECT_EQ(sensor.receiver.returns.size(), 2U);
  EXPECT_EQ(sensor.weather->visibility_m, 100.0);
  EXPECT_EQ(sensor.weather->rain_mm_per_h, 5.0);
  EXPECT_EQ(sensor.weather->snow_mm_per_h, 0.5);
  EXPECT_EQ(sensor.name, preset("VLP-16").name);
  EXPECT_FALSE(with(preset("VLP-16"), SensorOptions()).weather);
}

TEST(SensorOptions, ReturnsAreNamesOrACountOfTheNearest) {
  EXPECT_EQ(parse_returns("returns", {"3"}).size(), 3U);
  EXPECT_EQ(parse_returns("returns", {"last"})[0].order, Return::Order::farthest);
  const TestFolder folder;
  const auto error = [&](const std::vector<std::string>& words) {
    return error_of(folder, [&] { parse_returns("returns", words); });
  };
  const std::string allowed =
      "; allowed: 1 to 16 of first, second, third, last, strongest, second_strongest, with commas "
      "and no spaces; or how many of the nearest, 1 to 16";
  EXPECT_EQ(error({"strogest"}), "returns: 'strogest'" + allowed + "; did you mean strongest?");
  EXPECT_EQ(error({"0"}), "returns: '0'" + allowed);
  EXPECT_EQ(error({"17"}), "returns: '17'" + allowed);
  EXPECT_EQ(error({"99999999999999999999"}), "returns: '99999999999999999999'" + allowed);
  EXPECT_EQ(error({}), "returns: 0 returns" + allowed);
  EXPECT_EQ(error(std::vector<std::string>(17, "last")), "returns: 17 returns" + allowed);
}

TEST(SensorOptions, RefuseWhatTheSensorDoesNotHave) {
  EXPECT_EQ(error_with("Livox-Mid-40", &SensorOptions::columns_per_turn, 100),
            "columns_per_turn: the sensor does not spin; allowed: a spinning sensor; leave it out, "
            "or choose a sensor that spins (glidar sensors)");
  EXPECT_EQ(error_with("Kinect-v2", &SensorOptions::returns, parse_returns("", {"2"})),
            "returns: the sensor has no pulse light; allowed: a sensor with pulse light; leave it "
            "out, or choose a sensor such as VLP-16");
  EXPECT_NE(
      error_with("Kinect-v2", &SensorOptions::rain_mm_per_h, 1.0).find("has no lidar_equation"),
      std::string::npos);
}

TEST(SensorOptions, RefuseNumbersOutOfRange) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  constexpr double kNone = kNaN;
  EXPECT_EQ(error_with("VLP-16", &SensorOptions::rate_hz, 0.0),
            "rate_hz: 0; allowed: hertz above 0");
  EXPECT_EQ(error_with("VLP-16", &SensorOptions::rate_hz, kInfinite),
            "rate_hz: inf; allowed: hertz above 0");
  EXPECT_EQ(error_with("VLP-16", &SensorOptions::columns_per_turn, 0),
            "columns_per_turn: '0'; allowed: a whole number from 1 to 1048576");
  EXPECT_EQ(error_with("VLP-16", &SensorOptions::columns_per_turn, 1048577),
            "columns_per_turn: '1048577'; allowed: a whole number from 1 to 1048576");
  EXPECT_EQ(error_with("VLP-16", &SensorOptions::visibility_m, -1.0),
            "visibility_m: -1; allowed: a number from 0 to 1000000");
  EXPECT_EQ(error_with("VLP-16", &SensorOptions::rain_mm_per_h, 1001.0),
            "rain_mm_per_h: 1001; allowed: a number from 0 to 1000");
  EXPECT_EQ(error_with("VLP-16", &SensorOptions::snow_mm_per_h, kNone),
            "snow_mm_per_h: nan; allowed: a number from 0 to 1000");
}

}  // namespace
}  // namespace glidar
