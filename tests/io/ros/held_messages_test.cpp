// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/held_messages.hpp>

#include <gmock/gmock.h>

namespace glidar::ros {
namespace {

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

TEST(HeldMessages, ReuseTheSmallestLargeMemoryThatFits) {
  HeldMessages messages;
  EXPECT_EQ(messages.take_memory(100'000).capacity(), 0U);
  messages.give_back(std::vector<std::byte>(300'000));
  messages.give_back(std::vector<std::byte>(200'000));
  EXPECT_EQ(messages.take_memory(10).capacity(), 0U);  // small messages do not hold large memory
  EXPECT_EQ(messages.take_memory(100'000).capacity(), 200'000U);
  EXPECT_EQ(messages.take_memory(100'000).capacity(), 300'000U);
  EXPECT_EQ(messages.take_memory(100'000).capacity(), 0U);
}

}  // namespace
}  // namespace glidar::ros
