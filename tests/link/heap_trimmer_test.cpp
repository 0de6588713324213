// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/socket.hpp>

#include <gtest/gtest.h>

#include <malloc.h>
#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <memory>
#include <vector>

namespace glidar::link {
namespace {

std::int64_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::int64_t all = 0;
  std::int64_t resident = 0;
  file >> all >> resident;
  return resident * ::sysconf(_SC_PAGESIZE);
}

/// Frees many small pieces; the last one stays, so that the end of the heap cannot shrink.
std::unique_ptr<std::vector<char>> free_among_others() {
  constexpr std::size_t kPieces = 64 << 10;
  std::vector<std::unique_ptr<std::vector<char>>> pieces;
  for (std::size_t i = 0; i < kPieces; ++i)
    pieces.push_back(std::make_unique<std::vector<char>>(1000, 'x'));
  return std::move(pieces.back());
}

TEST(HeapTrimmer, ReturnsFreedMemoryAfterAPeerHasLeft) {
#ifndef __GLIBC__
  GTEST_SKIP() << "the C library is not glibc; run it with glibc";
#else
  const auto last = free_among_others();
  constexpr std::int64_t kSome_bytes = 32 << 20;
  if (::mallinfo2().fordblks < kSome_bytes)
    GTEST_SKIP() << "another allocator is in use; run it without sanitizers";
  const std::int64_t before = resident_bytes();
  HeapTrimmer trimmer;
  HeapTrimmer::Clock::time_point now = HeapTrimmer::Clock::now();
  trimmer.check(now);
  EXPECT_GT(resident_bytes(), before - kSome_bytes) << "nobody has left";
  trimmer.expect();
  EXPECT_TRUE(trimmer.is_waiting());
  trimmer.check(now);
  EXPECT_LT(resident_bytes(), before - kSome_bytes);
#endif
}

TEST(HeapTrimmer, ChecksAFewTimesAfterTheLastPeerHasLeft) {
  HeapTrimmer trimmer;
  HeapTrimmer::Clock::time_point now = HeapTrimmer::Clock::now();
  trimmer.expect();
  int checks = 0;
  for (; trimmer.is_waiting() && checks < 100; ++checks) {
    trimmer.check(now);
    trimmer.check(now);
    now += HeapTrimmer::kPause;
  }
  EXPECT_GT(checks, 1) << "what other threads free a little later is returned too";
  EXPECT_LT(checks, 10);
}

}  // namespace
}  // namespace glidar::link
