// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/protocol.hpp>

#include <gmock/gmock.h>

#include <vector>

namespace glidar::foxglove {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

std::vector<std::pair<ChannelId, std::uint64_t>> drain(MessageQueue& queue) {
  std::vector<std::pair<ChannelId, std::uint64_t>> all;
  while (const auto message = queue.pop()) all.emplace_back(message->channel, message->time_ns);
  return all;
}

TEST(MessageQueue, KeepsTheNewestMessagesOfEachChannel) {
  MessageQueue queue;
  std::size_t dropped = 0;
  for (std::uint64_t time = 0; time < 5; ++time) {
    dropped += queue.push({.channel = 1, .time_ns = time}, 1);
    dropped += queue.push({.channel = 2, .time_ns = time}, 3);
  }
  EXPECT_EQ(dropped, 6U);
  EXPECT_EQ(queue.size(), 4U);
  EXPECT_THAT(drain(queue), ElementsAre(Pair(1, 4), Pair(2, 2), Pair(2, 3), Pair(2, 4)));
}

TEST(MessageQueue, KeepsThePlaceOfAChannelWhenItsMessageIsReplaced) {
  MessageQueue queue;
  queue.push({.channel = 1, .time_ns = 0}, 1);
  queue.push({.channel = 2, .time_ns = 1}, 1);
  queue.push({.channel = 1, .time_ns = 2}, 1);
  EXPECT_EQ(queue.pop()->time_ns, 2U);
  queue.push({.channel = 3, .time_ns = 3}, 1);
  queue.remove(2);
  EXPECT_THAT(drain(queue), ElementsAre(Pair(3, 3)));
}

}  // namespace
}  // namespace glidar::foxglove
