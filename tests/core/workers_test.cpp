// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/workers.hpp>

#include "support/waiting.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

namespace glidar {
namespace {

/// Whether so many threads work on one loop at the same time: each waits until all have come.
bool meet(Workers& workers, std::size_t threads) {
  std::mutex mutex;
  std::set<std::thread::id> arrived;
  std::atomic<bool> is_complete{true};
  const auto have_all_come = [&] {
    const std::lock_guard lock(mutex);
    arrived.insert(std::this_thread::get_id());
    return arrived.size() >= threads;
  };
  workers.for_ranges(64 * threads, 1, [&](std::size_t, std::size_t) {
    if (!testing::soon(have_all_come)) is_complete = false;
  });
  return is_complete && arrived.size() == threads;
}

TEST(Workers, AreAsManyAsRequestedWhateverOthersRequestBefore) {
  Workers default_workers;
  default_workers.for_ranges(100, 1, [](std::size_t, std::size_t) {});
  ::testing::internal::CaptureStderr();
  for (const unsigned threads : {1U, 2U, 3U, 5U, 64U}) {
    const Workers workers(threads);
    EXPECT_EQ(workers.threads(), threads);
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Workers, RunAtTheSameTimeEvenWhenThereAreMoreThanProcessors) {
  const unsigned threads = std::thread::hardware_concurrency() + 3;
  Workers workers(threads);
  EXPECT_TRUE(meet(workers, threads));
}

TEST(Workers, AreAsManyAsPossibleWhenMoreAreRequested) {
  ::testing::internal::CaptureStderr();
  const Workers workers(100'000);
  EXPECT_GE(workers.threads(), 256U);
  EXPECT_LE(workers.threads(), 1024U);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Workers, CoverEveryIndexOnce) {
  constexpr std::size_t kCount = 10'000;
  for (const unsigned threads : {1U, 2U, 5U, 64U}) {
    Workers workers(threads);
    std::vector<std::atomic<int>> visits(kCount);
    workers.for_ranges(kCount, 7, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    for (std::size_t i = 0; i < kCount; ++i) ASSERT_EQ(visits[i], 1) << i;
  }
}

}  // namespace
}  // namespace glidar
