// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/sensor_topics.hpp>

#include <gmock/gmock.h>

#include <limits>

namespace glidar::ros {
namespace {

TEST(FrameArrivals, OfOneSensorAreCompleteUntilItsNextFrame) {
  FrameArrivals arrivals(1, true);
  arrivals.add(0, 1000, 100);
  EXPECT_EQ(arrivals.complete_ns(), 1100);
  EXPECT_EQ(arrivals.next_end_ns(), 1200);
}

TEST(FrameArrivals, OfARigAreCompleteUntilTheFirstOfTheNextFrames) {
  FrameArrivals arrivals(2, true);
  arrivals.add(0, 0, 100);
  EXPECT_EQ(arrivals.complete_ns(), 0);  // the other sensor may have a frame that begins now
  arrivals.add(1, 0, 30);
  EXPECT_EQ(arrivals.complete_ns(), 30);
  EXPECT_EQ(arrivals.next_end_ns(), 60);
}

TEST(FrameArrivals, DoNotWaitForASensorThatEnded) {
  FrameArrivals arrivals(2, true);
  arrivals.add(1, 0, 30);
  arrivals.add(0, 100, 100);
  EXPECT_EQ(arrivals.complete_ns(), 100);
}

TEST(FrameArrivals, OfGivenPosesAreCompleteWithTheLastSensor) {
  FrameArrivals arrivals(2, false);
  arrivals.add(0, 50, 100);
  EXPECT_EQ(arrivals.complete_ns(), 50);
  arrivals.add(1, 50, 100);
  EXPECT_EQ(arrivals.complete_ns(), std::numeric_limits<std::int64_t>::max());
}

TEST(FrameArrivals, BeginAnewAfterAStepBack) {
  FrameArrivals arrivals(1, true);
  EXPECT_TRUE(arrivals.add(0, 1000, 100));
  EXPECT_FALSE(arrivals.add(0, 500, 100));
  EXPECT_EQ(arrivals.complete_ns(), 600);
}

using ::testing::ElementsAre;

TEST(HeldMessages, AreReleasedByTimeAndInTheirOrderWithinOne) {
  HeldMessages messages;
  messages.hold({.time_ns = 5, .topic = 0, .bytes = {}});
  messages.hold({.time_ns = 3, .topic = 1, .bytes = {}});
  messages.hold({.time_ns = 5, .topic = 2, .bytes = {}});
  std::vector<std::size_t> topics;
  while (const auto message = messages.release(5)) topics.push_back(message->topic.value());
  EXPECT_THAT(topics, ElementsAre(1U, 0U, 2U));
}

TEST(HeldMessages, StayUntilTheirTime) {
  HeldMessages messages;
  messages.hold({.time_ns = 5, .topic = 0, .bytes = {}});
  EXPECT_FALSE(messages.release(4));
  EXPECT_TRUE(messages.release(5));
  EXPECT_FALSE(messages.release(6));
}

TEST(HeldMessages, ReuseTheMemoryOfWrittenOnes) {
  HeldMessages messages;
  Image image;
  image.data = Payload(std::vector<std::byte>(100'000));
  messages.hold(0, 1, image);
  std::vector<std::byte> written = std::move(messages.release(1)->bytes);
  const std::byte* memory = written.data();
  messages.give_back(std::move(written));
  messages.hold(0, 2, image);
  EXPECT_EQ(messages.release(2)->bytes.data(), memory);
}

}  // namespace

}  // namespace glidar::ros
