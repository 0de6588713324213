// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/console.hpp>

#include <gtest/gtest.h>
#include <unistd.h>
#include <support/waiting.hpp>

#include <chrono>
#include <string>

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

TEST(ProgressText, HasPercentAndTimeLeftWithoutABar) {
  EXPECT_EQ(progress_text("frame 12 of 200", 0.055, 11.0), "frame 12 of 200, 5 %, 3 min 09 s left");
  EXPECT_EQ(progress_text("loading a.ply", -1.0, 20.4), "loading a.ply, 20 s so far");
}

TEST(ProgressScope, WritesALineInEachIntervalWithoutATerminal) {
  ::testing::internal::CaptureStderr();
  {
    Console console(false, std::chrono::milliseconds(1));
    ProgressScope run(console, "frame", 200);
    for (int i = 0; i < 12; ++i) run.next();
    const ProgressScope inner(console, "casting 5 beams");
    console.set_progress(0.5);
    const auto written = [] { return ::lseek(STDERR_FILENO, 0, SEEK_CUR); };
    EXPECT_TRUE(testing::soon([&, before = written()] { return written() > before; }));
  }
  const std::string text = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(text.find("glidar: frame 12 of 200, 5 %, "), std::string::npos) << text;
  EXPECT_EQ(text.find("casting"), std::string::npos) << text;
}

TEST(ProgressScope, IsSilentWithQuiet) {
  ::testing::internal::CaptureStderr();
  {
    Console console(true, std::chrono::milliseconds(0));
    const ProgressScope run(console, "frame", 200);
    const ProgressScope inner(console, "casting");
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(ProgressScope, NeverRunsBackwardsWhenATaskWithinACountedOneBegins) {
  ::testing::internal::CaptureStderr();
  {
    Console console(false, std::chrono::milliseconds(1));
    ProgressScope run(console, "frame", 2);
    run.next();
    const auto written = [] { return ::lseek(STDERR_FILENO, 0, SEEK_CUR); };
    const auto wait_for_line = [&] {
      return testing::soon([&, before = written()] { return written() > before; });
    };
    {
      const ProgressScope casting(console, "casting");
      console.set_progress(0.9);
      EXPECT_TRUE(wait_for_line() && wait_for_line());
    }
    const ProgressScope writing(console, "writing");
    EXPECT_TRUE(wait_for_line() && wait_for_line());
  }
  const std::string text = ::testing::internal::GetCapturedStderr();
  const std::size_t cast = text.find("frame 1 of 2, 45 %");
  ASSERT_NE(cast, std::string::npos) << text;
  EXPECT_EQ(text.find(", 0 %", cast), std::string::npos) << text;
}

}  // namespace
}  // namespace glidar::app
