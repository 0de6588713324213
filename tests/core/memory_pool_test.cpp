// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/memory_pool.hpp>

#include <gtest/gtest.h>

namespace glidar {
namespace {

TEST(MemoryPool, ReusesTheSmallestLargeMemoryThatFits) {
  MemoryPool pool;
  EXPECT_EQ(pool.take(100'000).capacity(), 0U);
  pool.give_back(std::vector<std::byte>(300'000));
  pool.give_back(std::vector<std::byte>(200'000));
  EXPECT_EQ(pool.take(10).capacity(), 0U);  // small messages do not hold large memory
  EXPECT_EQ(pool.take(100'000).capacity(), 200'000U);
  EXPECT_EQ(pool.take(100'000).capacity(), 300'000U);
  EXPECT_EQ(pool.take(100'000).capacity(), 0U);
}

TEST(MemoryPool, KeepsTheLastEight) {
  MemoryPool pool;
  for (std::size_t size = 100'000; size < 100'010; ++size)
    pool.give_back(std::vector<std::byte>(size));
  for (std::size_t size = 100'002; size < 100'010; ++size)
    EXPECT_EQ(pool.take(100'000).capacity(), size);
  EXPECT_EQ(pool.take(100'000).capacity(), 0U);
}

TEST(MemoryPool, DoesNotKeepSmallMemory) {
  MemoryPool pool;
  pool.give_back(std::vector<std::byte>(kMinReused_bytes - 1));
  EXPECT_EQ(pool.take(kMinReused_bytes).capacity(), 0U);
  pool.give_back(std::vector<std::byte>(kMinReused_bytes));
  EXPECT_EQ(pool.take(kMinReused_bytes).capacity(), kMinReused_bytes);
}

}  // namespace
}  // namespace glidar
