// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/report.hpp>
#include <glidar/math/thread_pool.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace glidar {
namespace {

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
