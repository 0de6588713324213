// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/excerpt.hpp>

#include <gtest/gtest.h>

namespace glidar {
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

TEST(Excerpt, MultiByteCharactersAreNotSplit) {
  const std::string euros = "\xE2\x82\xAC\xE2\x82\xAC\xE2\x82\xAC";
  EXPECT_EQ(excerpt(euros, 9), euros);
  EXPECT_EQ(excerpt(euros, 8), "\xE2\x82\xAC...");
  EXPECT_EQ(excerpt(euros, 7), "\xE2\x82\xAC...");
  EXPECT_EQ(excerpt(std::string(9, '\x80'), 8), "...");
}

}  // namespace
}  // namespace glidar
