// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/interrupt.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>

namespace glidar::app {
namespace {

constexpr int kAfterSigterm = 128 + SIGTERM;

/// Work that ignores requests to stop.
[[noreturn]] void work_on() {
  for (;;) pause();
}

TEST(SignalText, NamesTheCauseInPlainWords) {
  EXPECT_EQ(signal_text(SIGINT), "interrupted by Ctrl-C (SIGINT)");
  EXPECT_EQ(signal_text(SIGTERM), "terminated (SIGTERM)");
  EXPECT_EQ(signal_text(SIGHUP), "the terminal was closed (SIGHUP)");
  EXPECT_EQ(signal_text(SIGUSR1), "stopped by signal " + std::to_string(SIGUSR1));
}

TEST(StopRequestDeathTest, SigtermEndsWorkThatIgnoresIt) {
  EXPECT_EXIT(
      {
        const StopRequest stop;
        raise(SIGTERM);
        work_on();
      },
      ::testing::ExitedWithCode(kAfterSigterm), "interrupted");
}

TEST(StopRequestDeathTest, WorkThatStopsExitsInOrder) {
  EXPECT_EXIT(
      {
        const StopRequest stop;
        raise(SIGTERM);
        stop.disarm();
        std::_Exit(stop.signal() == SIGTERM ? 7 : 1);
      },
      ::testing::ExitedWithCode(7), "^$");
}

TEST(StopRequestDeathTest, ASecondSignalEndsItAtOnce) {
  EXPECT_EXIT(
      {
        const StopRequest stop;
        raise(SIGINT);
        raise(SIGINT);
        work_on();
      },
      ::testing::ExitedWithCode(128 + SIGINT), "interrupted");
}

}  // namespace
}  // namespace glidar::app
