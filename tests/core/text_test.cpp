// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/text.hpp>
#include <glidar/math/constants.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace

namespace {

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

}  // namespace

namespace {

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

}  // namespace
}  // namespace glidar
