// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/text.hpp>

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
}  // namespace glidar
