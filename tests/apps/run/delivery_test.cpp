// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/delivery.hpp>
#include <apps/glidar/run/stream_report.hpp>

#include "support/waiting.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace glidar::app {
namespace {

TEST(Delivery, DeliversEveryFrameInOrder) {
  std::vector<std::uint32_t> delivered;
  Delivery delivery(
      [&](const MeasuredFrame& measured) { delivered.push_back(measured.frame.number); }, [] {},
      [] {});
  for (std::uint32_t k = 0; k < 100; ++k) {
    delivery.next_slot().frame.number = k;
    delivery.submit();
  }
  delivery.finish();
  ASSERT_EQ(delivered.size(), 100U);
  for (std::uint32_t k = 0; k < 100; ++k) EXPECT_EQ(delivered[k], k);
}

/// Every frame except the last is delivered while the next one is filled.
TEST(Delivery, NeverTouchesAFrameThatIsBeingDelivered) {
  constexpr int kFrames = 50;
  std::atomic<const MeasuredFrame*> busy{nullptr};
  std::atomic<int> begun{0};
  std::atomic<int> filled{0};
  Delivery delivery(
      [&](const MeasuredFrame& measured) {
        busy = &measured;
        const int next = ++begun;
        EXPECT_TRUE(testing::soon([&] { return next == kFrames || filled > next; }));
        busy = nullptr;
      },
      [] {}, [] {});
  for (int k = 0; k < kFrames; ++k) {
    ASSERT_TRUE(testing::soon([&] { return begun == k; }));
    const MeasuredFrame& measured = delivery.next_slot();
    EXPECT_EQ(busy.load() != nullptr, k > 0);
    EXPECT_NE(&measured, busy.load());
    ++filled;
    delivery.submit();
  }
  delivery.finish();
  EXPECT_EQ(begun, kFrames);
}

TEST(Delivery, ReportsErrorsAtOnceAndRethrowsThem) {
  std::atomic<int> failures{0};
  Delivery delivery([](const MeasuredFrame&) { throw std::runtime_error("disk full"); }, [] {},
                    [&] { ++failures; });
  delivery.next_slot();
  delivery.submit();
  ASSERT_TRUE(testing::soon([&] { return failures > 0; }));
  EXPECT_EQ(failures, 1);
  EXPECT_THROW(delivery.finish(), std::runtime_error);
}

TEST(Delivery, CallsIdleWithoutFrames) {
  std::atomic<int> idle{0};
  Delivery delivery([](const MeasuredFrame&) {}, [&] { ++idle; }, [] {});
  EXPECT_TRUE(testing::soon([&] { return idle >= 3; }));
}

TEST(DurationHistogram, HasQuantilesToTwoPercent) {
  DurationHistogram histogram;
  EXPECT_EQ(histogram.quantile_s(0.5), 0.0);
  for (int k = 1; k <= 1000; ++k) histogram.add(1e-3 * k);
  EXPECT_NEAR(histogram.quantile_s(0.5), 0.5, 0.02 * 0.5);
  EXPECT_NEAR(histogram.quantile_s(0.99), 0.99, 0.02 * 0.99);
  EXPECT_EQ(histogram.quantile_s(1.0), 1.0);
  EXPECT_EQ(histogram.max_s(), 1.0);
}

TEST(DurationHistogram, AcceptsAnyDuration) {
  DurationHistogram histogram;
  for (const double s : {-1.0, 0.0, 1e-12, 1e9}) histogram.add(s);
  EXPECT_EQ(histogram.count(), 4U);
  EXPECT_EQ(histogram.max_s(), 1e9);
}

}  // namespace
}  // namespace glidar::app
