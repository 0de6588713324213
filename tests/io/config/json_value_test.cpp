// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/io/config/json_value.hpp>

#include <support/error_text.hpp>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace glidar
