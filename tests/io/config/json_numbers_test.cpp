// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/unit_conversion.hpp>
#include <glidar/io/config/json_numbers.hpp>

#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/formats/sidecar.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/sensor.hpp>

#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <filesystem>

namespace glidar {
namespace {

TEST(InUnit, ADecimalNumberOfUpTo15DigitsComesBack) {
  for (const double unit : {1e-9, 1e-3, 1e3, kDegree, 1.0}) {
    for (const double number : {903.0, 0.1, -15.0, 1.133, 55.296, 123456.789012345, 1e-7, 0.0}) {
      EXPECT_EQ(in_unit(number * unit, unit), number) << number << " in " << unit;
    }
  }
}

TEST(InUnit, ANumberOfMoreDigitsIsNotRounded) {
  constexpr double kThird = 1.0 / 3.0;
  EXPECT_EQ(in_unit(kThird, 1.0), kThird);
  EXPECT_TRUE(std::isinf(in_unit(HUGE_VAL, 1e-3)));
  EXPECT_TRUE(std::isnan(in_unit(std::nan(""), 1e-3)));
}

TEST(RemoveNegativeZeros, ReachesEveryNumberAndNothingElse) {
  nlohmann::ordered_json json = {{"a", -0.0}, {"b", {1, -0.0, {{"c", -0.0}}}}, {"d", "-0.0"}};
  remove_negative_zeros(json);
  EXPECT_EQ(json.dump(), R"({"a":0.0,"b":[1,0.0,{"c":0.0}],"d":"-0.0"})");
}

/// Digits of the number that ends before `end`.
std::size_t digits_before(const std::string& text, std::size_t end) {
  std::size_t count = 0;
  while (count < end && (std::isdigit(text[end - 1 - count]) != 0 || text[end - 1 - count] == '.'))
    ++count;
  return count;
}

TEST(SensorText, NoPresetHasNegativeZerosOrRoundedTails) {
  for (const SensorPreset& preset : sensor_presets()) {
    const std::string& name = preset.name;
    const Sensor sensor = load_sensor_file(preset.reference);
    const std::string text = sensor_to_json(sensor, make_beams(sensor));
    EXPECT_EQ(text.find("-0.0,"), std::string::npos) << name;
    EXPECT_EQ(text.find("-0.0\n"), std::string::npos) << name;
    if (name == "picoScan150") continue;  // computes steps of 0.1 degrees, with roundings
    for (const char* tail : {"00000001", "00000002", "99999999"}) {
      for (std::size_t at = text.find(tail); at != std::string::npos;
           at = text.find(tail, at + 1)) {
        // metres, which files give in millimetres: one rounding
        if (text.substr(at - 40, 40).find("range_offset_m") != std::string::npos) continue;
        if (text.substr(at - 40, 40).find("max_rad") != std::string::npos) continue;  // the same
        EXPECT_LT(digits_before(text, at + 8), 16U) << name << ": " << text.substr(at - 12, 24);
      }
    }
  }
}

}  // namespace
}  // namespace glidar
