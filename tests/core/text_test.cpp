// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/text.hpp>

#include <glidar/core/file_text.hpp>
#include <glidar/core/time_text.hpp>
#include <glidar/math/constants.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <sstream>
#include <type_traits>

namespace glidar {
namespace {

using ::testing::ElementsAre;

TEST(Text, OnlyAsciiLettersBecomeLowerCase) {
  EXPECT_EQ(lower_case("A-z_9 \u00C4"), "a-z_9 \u00C4");
}

TEST(Text, IsTrimmedAtBothEnds) {
  EXPECT_EQ(trimmed(" \t a b\r\n"), "a b");
  EXPECT_EQ(trimmed("\"a b\" ", " \""), "a b");
  EXPECT_EQ(trimmed(" \n"), "");
}

TEST(Text, IsSplitAtEverySeparator) {
  EXPECT_THAT(split("a,,b", ','), ElementsAre("a", "", "b"));
  EXPECT_THAT(split("", ','), ElementsAre(""));
}

TEST(Text, SizesOfUtf8CharactersFollowRfc3629) {
  EXPECT_EQ(utf8_size("ab"), 1U);
  EXPECT_EQ(utf8_size("\u00B5m"), 2U);
  EXPECT_EQ(utf8_size("\u2264"), 3U);
  EXPECT_EQ(utf8_size("\U0001F6F0"), 4U);
  // empty, a later byte, cut off, overlong, a surrogate, beyond U+10FFFF
  for (const char* invalid :
       {"", "\x80", "\xE2\x89", "\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80"}) {
    EXPECT_EQ(utf8_size(invalid), 0U) << invalid;
  }
}

TEST(Excerpt, ShortTextIsUnchanged) {
  EXPECT_EQ(excerpt(""), "");
  EXPECT_EQ(excerpt("word"), "word");
  EXPECT_EQ(excerpt(std::string(kMaxExcerpt_bytes, 'x')), std::string(kMaxExcerpt_bytes, 'x'));
}

TEST(Excerpt, LongTextIsCutToTheLimitIncludingTheDots) {
  const std::string cut = excerpt(std::string(1'000'000, 'x'));
  EXPECT_EQ(cut, std::string(kMaxExcerpt_bytes - 3, 'x') + "...");
  EXPECT_EQ(excerpt("abcdefgh", 5), "ab...");
}

TEST(Excerpt, ControlCharactersBecomeQuestionMarks) {
  EXPECT_EQ(excerpt(std::string_view("a\0b\n\x1b[31m\x7f", 10)), "a?b??[31m?");
}

TEST(Excerpt, BytesThatAreNoUtf8BecomeQuestionMarks) {
  EXPECT_EQ(excerpt("a\xDF\x80z"), "a\xDF\x80z");
  EXPECT_EQ(excerpt("\xDFz"), "?z");
  EXPECT_EQ(excerpt("\xE2\x82"), "??");
  EXPECT_EQ(excerpt("\xC0\x80"), "??") << "longer than necessary";
  EXPECT_EQ(excerpt("\xED\xA0\x80"), "???") << "half of a pair";
  EXPECT_EQ(excerpt("\xF4\x90\x80\x80"), "????") << "beyond U+10FFFF";
  EXPECT_EQ(excerpt("\xF0\x9F\x9B\xB0"), "\xF0\x9F\x9B\xB0");
}

TEST(Excerpt, ControlCharactersOfTwoBytesBecomeQuestionMarks) {
  EXPECT_EQ(excerpt("\xC2\x9B"
                    "31m"),
            "??31m")
      << "U+009B begins a control sequence";
  EXPECT_EQ(excerpt("\xC2\xA0\xC2\xB5"), "\xC2\xA0\xC2\xB5");
}

TEST(Excerpt, CharactersThatReorderOrHideOthersBecomeQuestionMarks) {
  for (const char* hidden :
       {"\u00AD", "\u061C", "\u180E", "\u200B", "\u200E", "\u200F", "\u2028", "\u2029", "\u202A",
        "\u202E", "\u2060", "\u2066", "\u2069", "\uFEFF", "\uFFF9", "\U000E0041"}) {
    const std::string bytes = hidden;
    EXPECT_EQ(printable_line("a" + bytes + "b"), "a" + std::string(bytes.size(), '?') + "b")
        << hidden;
  }
  for (const char* shown : {"\u00E9", "\u0416", "\u05D0", "\u2027", "\u202F", "\u20AC", "\u8ECA",
                            "\uFFFD", "\U0001F697"})
    EXPECT_EQ(printable_line(shown), shown);
}

TEST(Excerpt, LinesKeepTheirEndsAndTabs) {
  EXPECT_EQ(printable_lines("a\tb\nc\r\x1b[0m\x9b\n"), "a\tb\nc??[0m?\n");
  EXPECT_EQ(printable_line("a\tb\nc"), "a?b?c");
}

TEST(Excerpt, MultiByteCharactersAreNotSplit) {
  const std::string euros = "\xE2\x82\xAC\xE2\x82\xAC\xE2\x82\xAC";
  EXPECT_EQ(excerpt(euros, 9), euros);
  EXPECT_EQ(excerpt(euros, 8), "\xE2\x82\xAC...");
  EXPECT_EQ(excerpt(euros, 7), "\xE2\x82\xAC...");
  EXPECT_EQ(excerpt(std::string(9, '\x80'), 8), "...");
}

TEST(DecimalText, HasTheRequestedNumberOfDecimals) {
  EXPECT_EQ(decimal_text(3.14159), "3.14");
  EXPECT_EQ(decimal_text(-0.0625, 3), "-0.063");
  EXPECT_EQ(decimal_text(2.005, 0), "2");
  EXPECT_EQ(decimal_text(-0.001), "0.00");
  EXPECT_EQ(decimal_text(1234567.5, 1), "1234567.5");
}

TEST(DecimalText, NamesWhatIsNoNumber) {
  EXPECT_EQ(decimal_text(kNaN), "none");
  EXPECT_EQ(decimal_text(kInfinity), "none");
}

TEST(TimeText, SecondsAreExactToTheNanosecondInEveryNotation) {
  constexpr std::int64_t kTime_ns = 1'403'636'580'838'555'648;
  for (const char* text : {"1403636580.838555648", "1.403636580838555648e+09",
                           "+1403636580838555648E-9", "0001403636580.8385556480"}) {
    EXPECT_EQ(parse_seconds_ns(text), kTime_ns) << text;
  }
  EXPECT_EQ(parse_seconds_ns("-0.000000001"), -1);
  EXPECT_EQ(parse_seconds_ns("7"), 7'000'000'000);
  EXPECT_EQ(parse_seconds_ns(".25"), 250'000'000);
  EXPECT_EQ(parse_seconds_ns("3."), 3'000'000'000);
  EXPECT_EQ(parse_seconds_ns("0.0000000015"), 2);
  EXPECT_EQ(parse_seconds_ns("0.00000000149"), 1);
  EXPECT_EQ(parse_seconds_ns("5e-10"), 1);
  EXPECT_EQ(parse_seconds_ns("4e-10"), 0);
  EXPECT_EQ(parse_seconds_ns("1e-300"), 0);
  EXPECT_EQ(parse_seconds_ns("-9200000000"), -9'200'000'000'000'000'000);
}

TEST(TimeText, OtherTextsAreNoSeconds) {
  for (const char* text :
       {"", ".", "-", "+-1", "1 ", " 1", "1,5", "0x10", "nan", "inf", "1e", "e5", "1e5.0", "1.2.3",
        "9200000001", "1e10", "1e300", "1403636580838555648"}) {
    EXPECT_EQ(parse_seconds_ns(text), std::nullopt) << text;
  }
}

TEST(TimeText, DatesAreInUtc) {
  EXPECT_EQ(parse_date_ns("1970-01-01T00:00:00Z"), 0);
  EXPECT_EQ(parse_date_ns("2026-01-01T00:00:00Z"), 1'767'225'600'000'000'000);
  EXPECT_EQ(parse_date_ns("2024-02-29T23:59:59.123456789Z"), 1'709'251'199'123'456'789);
  for (const char* text :
       {"", "2026-01-01", "2026-01-01T00:00:00", "2026-01-01 00:00:00Z", "2026-02-29T00:00:00Z",
        "2026-13-01T00:00:00Z", "2026-01-01T24:00:00Z", "2026-01-01T00:60:00Z",
        "2026-01-01T00:00:60Z", "2026-01-01T00:00:0Z", "2026-01-01T00:00:1e1Z",
        "1969-12-31T00:00:00Z", "2300-01-01T00:00:00Z", "+026-01-01T00:00:00Z"}) {
    EXPECT_EQ(parse_date_ns(text), std::nullopt) << text;
  }
}

TEST(TimeText, DecimalSecondsReadBack) {
  EXPECT_EQ(decimal_seconds(0), "0");
  EXPECT_EQ(decimal_seconds(-1), "-0.000000001");
  EXPECT_EQ(decimal_seconds(12'500'000'000), "12.5");
  EXPECT_EQ(decimal_seconds(std::numeric_limits<std::int64_t>::min()), "-9223372036.854775808");
  for (const std::int64_t t_ns : {1'700'000'000'123'456'789L, -1'000'000'007L, 100'000'000L}) {
    EXPECT_EQ(parse_seconds_ns(decimal_seconds(t_ns)), t_ns);
  }
}

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
