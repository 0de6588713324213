// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/thread_pool.hpp>

#include "support/waiting.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

namespace glidar {
namespace {

/// True if this number of threads work on one loop concurrently: each waits for all others. Later,
/// threads of other pools may take the places of some.
bool meet(ThreadPool& thread_pool, std::size_t threads) {
  std::mutex mutex;
  std::set<std::thread::id> arrived;
  std::atomic<bool> is_complete{true};
  const auto have_all_come = [&] {
    const std::lock_guard lock(mutex);
    arrived.insert(std::this_thread::get_id());
    return arrived.size() >= threads;
  };
  thread_pool.parallel_for(64 * threads, 1, [&](std::size_t, std::size_t) {
    if (!testing::soon(have_all_come)) is_complete = false;
  });
  return is_complete && arrived.size() >= threads;
}

TEST(ThreadPool, HasTheRequestedThreadsAfterOtherPools) {
  ThreadPool default_workers;
  default_workers.parallel_for(100, 1, [](std::size_t, std::size_t) {});
  ::testing::internal::CaptureStderr();
  for (const unsigned threads : {1U, 2U, 3U, 5U, 64U}) {
    const ThreadPool thread_pool(threads);
    EXPECT_EQ(thread_pool.threads(), threads);
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(ThreadPool, RunsMoreThreadsThanProcessorsConcurrently) {
  const unsigned threads = std::thread::hardware_concurrency() + 3;
  ThreadPool thread_pool(threads);
  EXPECT_TRUE(meet(thread_pool, threads));
}

TEST(ThreadPool, LimitsTheThreadsToThoseThatAreAllowed) {
  ::testing::internal::CaptureStderr();
  const ThreadPool thread_pool(100'000);
  EXPECT_GE(thread_pool.threads(), 256U);
  EXPECT_LE(thread_pool.threads(), 1024U);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(ThreadPool, CoversEveryIndexOnce) {
  constexpr std::size_t kCount = 10'000;
  for (const unsigned threads : {1U, 2U, 5U, 64U}) {
    ThreadPool thread_pool(threads);
    std::vector<std::atomic<int>> visits(kCount);
    thread_pool.parallel_for(kCount, 7, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    for (std::size_t i = 0; i < kCount; ++i) ASSERT_EQ(visits[i], 1) << i;
  }
}

}  // namespace
}  // namespace glidar
