// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/error_log.hpp>

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace glidar::link {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

class ErrorLogTest : public ::testing::Test {
 protected:
  std::vector<std::string> said;
  ErrorLog::Clock::time_point now;
  ErrorLog log{
      {.log = [this](Severity, std::string_view text) { said.emplace_back(text); }, .progress = {}},
      [this] { return now; }};
};

TEST_F(ErrorLogTest, LogsTheFirstErrorOfEachKindAtOnce) {
  log.report("short", "3 bytes");
  log.report("long", "300 bytes");
  EXPECT_THAT(said, ElementsAre("short: 3 bytes", "long: 300 bytes"));
}

TEST_F(ErrorLogTest, LogsAtMostOneLinePerSecondWithTheCount) {
  for (int i = 0; i < 1000; ++i) log.report("short", std::to_string(i));
  EXPECT_THAT(said, ElementsAre("short: 0"));
  now += std::chrono::seconds(1);
  log.report("short", "again");
  EXPECT_THAT(said, ElementsAre("short: 0", "short (1001 times): again"));
}

TEST_F(ErrorLogTest, TextOfPeersDoesNotControlTheTerminal) {
  log.report("page", "refused '\x1b]0;title\a\xDF'\n" + std::string(5000, 'x'));
  ASSERT_EQ(said.size(), 1U);
  EXPECT_THAT(said.front(), ::testing::StartsWith("page: refused '?]0;title?\?'?xxx"));
  EXPECT_LE(said.front().size(), 1100U);
}

TEST_F(ErrorLogTest, FlushLogsDelayedErrors) {
  log.report("short", "a");
  log.report("short", "b");
  log.report("long", "c");
  log.flush();
  log.flush();
  EXPECT_THAT(said, ElementsAre("short: a", "long: c", "short (2 times): b"));
  EXPECT_THAT(log.counts(), ElementsAre(Pair("long", 1U), Pair("short", 2U)));
}

}  // namespace
}  // namespace glidar::link
