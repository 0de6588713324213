// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/file_text.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sstream>
#include <type_traits>

namespace glidar {
namespace {

template <class Text>
concept Streamed = requires(std::ostream& to, const Text& text) {
  to << text;
};

TEST(FileText, IsNoStringAndCannotBePrinted) {
  static_assert(!std::is_convertible_v<FileText, std::string>);
  static_assert(!std::is_convertible_v<FileText, std::string_view>);
  static_assert(!std::is_convertible_v<FileText, const char*>);
  static_assert(!fmt::is_formattable<FileText>::value);
  static_assert(!Streamed<FileText> && Streamed<std::string>);
  EXPECT_EQ(FileText("a\x1b"
                     "b")
                .bytes(),
            "a\x1b"
            "b");
}

TEST(FileText, IsShownWithoutControlCharacters) {
  EXPECT_EQ(FileText("a\x1b[31m\n").shown(), "a?[31m?");
  EXPECT_EQ(FileText("abcdefgh").shown(5), "ab...");
}

TEST(FileText, ColumnNamesHaveLettersDigitsAndUnderscoresOnly) {
  const auto name = [](const char* text) { return FileText(text).column_name(); };
  EXPECT_EQ(name("normal_x2"), "normal_x2");
  EXPECT_EQ(name("../../../evil"), "_evil");
  EXPECT_EQ(name("a\nelement face 99"), "a_element_face_99");
  EXPECT_EQ(name("=cmd|x,\""), "_cmd_x_");
  EXPECT_EQ(name("\u8ECA"), "_");
  EXPECT_EQ(name(""), "field");
  EXPECT_EQ(name(std::string(1000, 'x').c_str()), std::string(64, 'x'));
  EXPECT_EQ(FileText(std::string("a\0b", 3)).column_name(), "a_b");
}

TEST(FileText, EveryColumnNameIsOne) {
  for (int first = 0; first < 256; ++first) {
    for (const char* rest : {"", "a", "\x80", "-"}) {
      const std::string text = std::string(1, static_cast<char>(first)) + rest;
      EXPECT_TRUE(is_column_name(FileText(text).column_name())) << first << rest;
    }
  }
  for (const char* text : {"", "a b", "a.b", "-a", "=a", "a\n", "\u00E9"})
    EXPECT_FALSE(is_column_name(text)) << text;
  EXPECT_FALSE(is_column_name(std::string(kMaxColumnName_bytes + 1, 'x')));
}

TEST(FileText, WordsHaveNoWhiteSpace) {
  const auto word = [](const char* text) { return FileText(text).word(); };
  EXPECT_EQ(word("traffic-sign"), "traffic-sign");
  EXPECT_EQ(word("a b\u00A0c\u2003d\u3000"
                 "e"),
            "a_b_c_d_e");
  EXPECT_EQ(word("a\nCar 0 0"), "a?Car_0_0");
  EXPECT_EQ(word("a\xC2\x85"
                 "b"),
            "a??b")
      << "the next line of C1";
  EXPECT_EQ(word("\u8ECA"), "\u8ECA");
  EXPECT_EQ(word(""), "_");
}

}  // namespace
}  // namespace glidar
