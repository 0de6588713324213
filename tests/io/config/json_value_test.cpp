// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>

#include <glidar/core/unit_conversion.hpp>
#include <glidar/io/config/json_numbers.hpp>
#include <glidar/io/config/json_value.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/formats/sidecar.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/sensor.hpp>

#include <gtest/gtest.h>
#include <support/error_text.hpp>

#include <cctype>
#include <cmath>
#include <filesystem>
#include <functional>

namespace glidar {
namespace {

const RefuseJson kRefuse = [](const std::string& found) { throw Error({"", found, "", ""}); };

/// What is found when the text is parsed and then read.
std::string found_in(
    const std::string& text, const std::function<void(const JsonValue&)>& read = [](auto&) {}) {
  return error_text([&] {
    const nlohmann::json json = parse_own_json("f", text, kRefuse);
    read(JsonValue(json, kRefuse));
  });
}

TEST(JsonValue, NamesThePlaceOfInvalidSyntax) {
  EXPECT_EQ(found_in("{\"a\": 1,\n \"b\": x}"),
            "its text is not valid JSON from line 2, column 7 on");
  EXPECT_EQ(found_in("{} {"), "its text is not valid JSON from column 4 on");
  EXPECT_EQ(found_in("\x01"), "its text is not valid JSON from column 1 on");
  EXPECT_EQ(found_in("[1e999]"), "a number is too large");
}

TEST(JsonValue, ReportsTruncatedText) {
  EXPECT_EQ(found_in("{\"a\": 1,\n"), "its text ends too early, at line 2, column 1");
  EXPECT_EQ(found_in("{\"a"), "its text ends too early, at column 4");
  EXPECT_EQ(found_in(""), "its text ends too early, at column 1");
  EXPECT_EQ(found_in(" \n"), "its text ends too early, at line 2, column 1");
}

TEST(JsonValue, NamesMissingKeys) {
  EXPECT_EQ(found_in("{\"a\": 1}", [](const JsonValue& json) { (void)json.at("frame"); }),
            "the key 'frame' is missing");
  EXPECT_EQ(found_in("{\"a\": [{\"b\": {}}]}",
                     [](const JsonValue& json) {
                       (void)json.at("a").items().at(0).at("b").at("folder");
                     }),
            "the key 'folder' is missing in 'a.0.b'");
}

TEST(JsonValue, NamesValuesOfAnotherType) {
  const std::string text = R"({"a": 1, "b": [true, -1], "c": {"d": [1, null, "x"]}})";
  const auto found = [&](const std::function<void(const JsonValue&)>& read) {
    return found_in(text, read);
  };
  EXPECT_EQ(found([](const JsonValue& json) { (void)json.at("a").text(); }),
            "a value of another type in 'a': a number instead of a text");
  EXPECT_EQ(found([](const JsonValue& json) { (void)json.at("a").at("b"); }),
            "a value of another type in 'a': a number instead of an object");
  EXPECT_EQ(found([](const JsonValue& json) { (void)json.items(); }),
            "a value of another type: an object instead of a list");
  EXPECT_EQ(found([](const JsonValue& json) { (void)json.at("b").numbers(); }),
            "a value of another type in 'b.0': true or false instead of a number");
  EXPECT_EQ(found([](const JsonValue& json) { (void)json.at("c").at("d").texts(); }),
            "a value of another type in 'c.d.0': a number instead of a text");
  EXPECT_EQ(found([](const JsonValue& json) { (void)json.at("c").at("d").numbers(); }),
            "a value of another type in 'c.d.1': null instead of a number");
}

TEST(JsonValue, ReadsWholeNumbersThatFit) {
  const nlohmann::json json = parse_own_json(
      "f", "[4294967295, 4294967296, -9223372036854775808, 9223372036854775808, 1.0]", kRefuse);
  const std::vector<JsonValue> values = JsonValue(json, kRefuse).items();
  EXPECT_EQ(values[0].count<std::uint32_t>(), 4294967295U);
  EXPECT_EQ(error_text([&] { (void)values[1].count<std::uint32_t>(); }),
            "1: 4294967296 is not a count");
  EXPECT_EQ(error_text([&] { (void)values[4].count<std::uint64_t>(); }), "4: 1.0 is not a count");
  EXPECT_EQ(values[2].integer(), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(error_text([&] { (void)values[3].integer(); }),
            "3: 9223372036854775808 is not a whole number of 64 bits");
  EXPECT_EQ(error_text([&] { (void)values[4].integer(); }),
            "4: 1.0 is not a whole number of 64 bits");
}

TEST(JsonValue, CutsLongValues) {
  const std::string found = found_in("\"" + std::string(1000, 'x') + "\"",
                                     [](const JsonValue& json) { (void)json.integer(); });
  EXPECT_LT(found.size(), 200U);
}

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
