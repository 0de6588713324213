// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/console.hpp>

#include <gtest/gtest.h>

namespace glidar::app {
namespace {

TEST(ProgressLine, ShowsABarWithPercentAndTimeLeft) {
  EXPECT_EQ(progress_line("casting", 0.25, 3.0, 80),
            "casting [#######.......................]  25 %, 9 s left");
  EXPECT_EQ(progress_line("casting", 0.5, 100.0, 80),
            "casting [###############...............]  50 %, 1 min 40 s left");
  EXPECT_EQ(progress_line("casting", 0.1, 900.0, 80),
            "casting [###...........................]  10 %, 2 h 15 min left");
}

TEST(ProgressLine, HasNoRemainingTimeAtTheStartAndNo100PercentTooEarly) {
  EXPECT_EQ(progress_line("a", 0.0, 3.0, 80), "a [..............................]   0 %");
  EXPECT_NE(progress_line("a", 0.9999, 3.0, 80).find(" 99 %"), std::string::npos);
}

TEST(ProgressLine, CountsSecondsIfTheFractionIsUnknown) {
  EXPECT_EQ(progress_line("loading x.ply", -1.0, 7.9, 80), "loading x.ply ... 7 s");
}

TEST(ProgressLine, FitsTheTerminal) {
  const std::string name(200, 'n');
  const std::string line = progress_line(name, 0.5, 1.0, 60);
  EXPECT_EQ(line.size(), 60U);
  EXPECT_TRUE(line.ends_with(" 50 %, 1 s left"));
  EXPECT_LE(progress_line(name, 0.5, 1.0, 10).size(), 10U);
}

}  // namespace
}  // namespace glidar::app
