// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/excerpt.hpp>
#include <glidar/io/config/json_error.hpp>

#include <gtest/gtest.h>

#include <functional>

#include <nlohmann/json.hpp>

namespace glidar {
namespace {

using Json = nlohmann::json;

/// The text about what the function throws.
std::string text_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Json::exception& error) {
    EXPECT_EQ(is_json_syntax_error(error.id),
              dynamic_cast<const Json::parse_error*>(&error) != nullptr);
    return json_error_text(error.id, error.what());
  }
  return "nothing thrown";
}

std::string text_of_parsing(const char* text) {
  return text_of([text] { [[maybe_unused]] const Json parsed = Json::parse(text); });
}

TEST(JsonErrorText, NamesThePlaceOfInvalidSyntax) {
  EXPECT_EQ(text_of_parsing("{\"a\": 1,\n \"b\": x}"),
            "its text is not valid JSON from line 2, column 7 on");
  EXPECT_EQ(text_of_parsing("no"), "its text is not valid JSON from column 2 on");
  EXPECT_EQ(text_of_parsing("\x01"), "its text is not valid JSON from column 1 on");
}

TEST(JsonErrorText, ReportsTruncatedText) {
  EXPECT_EQ(text_of_parsing("{\"a\": 1,\n"), "its text ends too early, at line 2, column 1");
  EXPECT_EQ(text_of_parsing("{\"a"), "its text ends too early, at column 4");
  EXPECT_EQ(text_of_parsing(""), "its text ends too early, at column 1");
}

TEST(JsonErrorText, NamesMissingKeysAndOtherTypes) {
  const Json json = {{"a", 1}};
  EXPECT_EQ(text_of([&] { (void)json.at("frame"); }), "the key 'frame' is missing");
  EXPECT_EQ(text_of([&] { (void)json.at("a").get<std::string>(); }),
            "a value of another type: type must be string, but is number");
  EXPECT_EQ(text_of([&] { (void)json.at("a").at("b"); }), "values of another structure");
  // as the library writes it with diagnostics
  EXPECT_EQ(
      json_error_text(403, "[json.exception.out_of_range.403] (/command/x) key 'folder' not found"),
      "the key 'folder' is missing in 'command.x'");
}

TEST(JsonErrorText, KeepsTheTextOfOwnErrors) {
  EXPECT_EQ(json_error_text(502, "[json.exception.other_error.502] (/rig) a body of 3 numbers"),
            "rig: a body of 3 numbers");
  EXPECT_LE(json_error_text(502, std::string(1000, 'x')).size(), kMaxExcerpt_bytes + 3);
}

}  // namespace
}  // namespace glidar
