// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>

#include <glidar/core/report.hpp>
#include <glidar/math/thread_pool.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {
namespace {

TEST(Error, MessageContainsAllFourParts) {
  const Error error({.where = "camera.yaml:3:8: width",
                     .found = "-5",
                     .allowed = "1 to 65536",
                     .remedy = "give a size in pixels"});
  EXPECT_STREQ(error.what(),
               "camera.yaml:3:8: width: -5; allowed: 1 to 65536; give a size in pixels");
  EXPECT_EQ(error.parts().found, "-5");
}

TEST(Error, MessageOmitsEmptyParts) {
  EXPECT_STREQ(Error({.where = "", .found = "broken"}).what(), "broken");
}

TEST(NumberText, IsTheShortestTextThatParsesToTheSameNumber) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(1e300), "1e+300");
  EXPECT_EQ(number_text(-2.0), "-2");
  EXPECT_EQ(number_text(std::nan("")), "nan");
  EXPECT_EQ(number_text(-2.2250738585072014e-308), "-2.2250738585072014e-308");
}

TEST(ClosestMatch, FindsTheMisspelledWord) {
  const std::vector<std::string> known = {"width", "height", "fov_deg"};
  EXPECT_EQ(closest_match("widht", known), "width");
  EXPECT_EQ(closest_match("fov_dge", known), "fov_deg");
}

TEST(ClosestMatch, FindsLongerAndShorterKeys) {
  const std::vector<std::string> pose = {"position", "orientation", "rotation_vector", "euler_deg"};
  EXPECT_EQ(closest_match("euler", pose), "euler_deg");
  EXPECT_EQ(closest_match("rotation", pose), "rotation_vector");
  EXPECT_EQ(closest_match("position_m", pose), "position");
  const std::vector<std::string> sensor = {"name", "rate_hz", "range_m", "fov_deg", "noise"};
  EXPECT_EQ(closest_match("range", sensor), "range_m");
  EXPECT_EQ(closest_match("rate", sensor), "rate_hz");
  EXPECT_EQ(closest_match("fov", sensor), "fov_deg");
  EXPECT_EQ(closest_match("deg", sensor), "fov_deg");
}

TEST(ClosestMatch, PrefersOneWrongLetterToALongerKey) {
  const std::vector<std::string> known = {"range_max_m", "ranges"};
  EXPECT_EQ(closest_match("range", known), "ranges");
}

TEST(ClosestMatch, CountsTranspositionsOnceAndIgnoresCase) {
  EXPECT_EQ(closest_match("rso", std::vector<std::string>{"gl", "ros"}), "ros");
  EXPECT_EQ(closest_match("EULER", std::vector<std::string>{"euler_deg"}), "euler_deg");
  EXPECT_EQ(closest_match("vlp-17", std::vector<std::string>{"VLP-16"}), "VLP-16");
}

TEST(ClosestMatch, KnowsTheWordsOfOtherPrograms) {
  const std::vector<std::string> model = {"model", "pose", "class", "materials", "centre"};
  EXPECT_EQ(closest_match("file", model), "model");
  EXPECT_EQ(closest_match("label", model), "class");
  EXPECT_EQ(closest_match("Color", model), "materials");
  EXPECT_EQ(closest_match("position", model), "pose");
  EXPECT_EQ(closest_match("rpy", std::vector<std::string>{"position", "euler_deg"}), "euler_deg");
  EXPECT_EQ(closest_match("--color-by", std::vector<std::string>{"--colour-by"}), "--colour-by");
  EXPECT_EQ(closest_match(".label.png", std::vector<std::string>{".png", ".class.png"}),
            ".class.png");
  EXPECT_EQ(closest_match("--pose", std::vector<std::string>{"--mode", "--sensor-pose"}),
            "--sensor-pose");
  EXPECT_EQ(closest_match("profile", std::vector<std::string>{"model"}), "");
}

TEST(ClosestMatch, DoesNotSuggestUnrelatedWords) {
  EXPECT_EQ(closest_match("w", std::vector<std::string>{"x", "y", "z"}), "");
  EXPECT_EQ(closest_match("up", std::vector<std::string>{"id", "optics"}), "");
  EXPECT_EQ(closest_match("fov", std::vector<std::string>{"fx", "fy", "far_m"}), "");
  EXPECT_EQ(closest_match("r", std::vector<std::string>{"rotation_vector"}), "");
  EXPECT_EQ(closest_match("", std::vector<std::string>{"id", "x"}), "");
  EXPECT_EQ(closest_match("colour", std::vector<std::string>{"mirror", "unit"}), "");
}

TEST(ClosestMatch, IsEmptyWhenNothingIsSimilar) {
  const std::vector<std::string> known = {"width", "height"};
  EXPECT_EQ(closest_match("temperature", known), "");
  EXPECT_EQ(closest_match("x", std::vector<std::string>{}), "");
}

TEST(Error, IsOnePrintableLineWhateverItsPartsContain) {
  const std::string hostile = "a\x1b]0;TITLE\x07\n\xC2\x9B\u202E\xFF";
  const std::string shown =
      "a?]0;TITLE????"
      "???"
      "?";
  const Error error({hostile, hostile, hostile, hostile});
  EXPECT_EQ(error.parts().where, shown);
  EXPECT_EQ(error.parts().found, shown);
  EXPECT_EQ(error.parts().allowed, shown);
  EXPECT_EQ(error.parts().remedy, shown);
  EXPECT_EQ(std::string(error.what()), shown + ": " + shown + "; allowed: " + shown + "; " + shown);
}

TEST(Report, MessagesAreOnePrintableLine) {
  std::vector<std::string> messages;
  const Report report{
      .log = [&](Severity, std::string_view message) { messages.emplace_back(message); },
      .progress = {}};
  report.info("a\x1b[2J\n");
  report.warn(
      "\u202E"
      "b");
  EXPECT_EQ(messages, (std::vector<std::string>{"a?[2J?", "???b"}));
}

TEST(ProgressCounter, ReportsIncreasingFractionsFromManyThreads) {
  std::vector<double> fractions;  // not guarded, because calls must not overlap
  const ProgressCallback progress = [&](double fraction) { fractions.push_back(fraction); };
  constexpr std::size_t kPieces = 1'000'000;
  std::vector<unsigned char> visits(kPieces, 0);
  ProgressCounter count(progress, kPieces);
  ThreadPool thread_pool(4);
  thread_pool.parallel_for(kPieces, 1000, [&](std::size_t begin, std::size_t end) {
    for (std::size_t first = begin; first < end; first += 100) {
      const std::size_t last = std::min(first + 100, end);
      for (std::size_t i = first; i < last; ++i) ++visits[i];
      count.add(last - first);
    }
  });
  count.finish();
  EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), std::ptrdiff_t{kPieces});
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_GT(fractions.size(), 10U);
  EXPECT_LE(fractions.size(), 1001U);  // for blocks of any size
  EXPECT_EQ(fractions.back(), 1.0);
}

TEST(ProgressCounter, ReportsNothingWithoutACallback) {
  const ProgressCallback nobody;
  ProgressCounter count(nobody, 100);
  EXPECT_NO_THROW(count.add(100));  // an empty function throws when it is called
  EXPECT_NO_THROW(count.finish());
}

}  // namespace

}  // namespace glidar
