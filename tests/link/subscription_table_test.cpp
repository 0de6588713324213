// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/subscription_table.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace glidar::link {
namespace {

const std::vector<std::string> kTopics = {"c", "/a", "/b"};
constexpr ConnectionId kUnknown = SubscriptionTable::kUnknownConnection;

TEST(SubscriptionTable, CountsConnectionsNotSubscriptions) {
  SubscriptionTable table;
  EXPECT_EQ(table.subscribers(kTopics), 0U);
  table.add({7, 100 + 7}, "/a");
  table.add({7, 100 + 7}, "/b");
  EXPECT_EQ(table.subscribers(kTopics), 1U);
  table.add({8, 100 + 8}, "/a");
  EXPECT_EQ(table.subscribers(kTopics), 2U);
}

TEST(SubscriptionTable, ASubscriptionCountsForTopicsThatBeginWithIt) {
  SubscriptionTable table;
  table.add({1, 100 + 1}, "");
  table.add({2, 100 + 2}, "/");
  table.add({3, 100 + 3}, "/ab");  // longer than any topic
  table.add({4, 100 + 4}, "x");
  EXPECT_EQ(table.subscribers(kTopics), 2U);
}

TEST(SubscriptionTable, AConnectionIsRemovedWithItsLastSubscription) {
  SubscriptionTable table;
  table.add({1, 100 + 1}, "/a");
  table.add({1, 100 + 1}, "/b");
  table.remove({1, 100 + 1}, "/a");
  EXPECT_EQ(table.subscribers(kTopics), 1U);
  table.remove({1, 100 + 1}, "/b");
  EXPECT_EQ(table.subscribers(kTopics), 0U);
}

TEST(SubscriptionTable, AnUnknownEndIsMatchedByTopics) {
  SubscriptionTable table;
  table.add({1, 100 + 1}, "/a");
  table.add({1, 100 + 1}, "c");
  table.add({2, 100 + 2}, "c");
  table.remove(kUnknown, "c");  // the second one ended
  EXPECT_EQ(table.subscribers(kTopics), 1U);
  EXPECT_EQ(table.subscribers(std::vector<std::string>{"/a"}), 1U);
  table.remove(kUnknown, "/a");
  table.remove(kUnknown, "c");
  EXPECT_EQ(table.subscribers(kTopics), 0U);
}

/// The system may give the number to a new connection before the end of the old one is reported.
TEST(SubscriptionTable, AReusedDescriptorCountsTwiceUntilTheEndIsReported) {
  SubscriptionTable table;
  table.add({1, 100}, "c");
  table.add({1, 101}, "c");
  EXPECT_EQ(table.subscribers(kTopics), 2U);
  table.remove(kUnknown, "c");
  EXPECT_EQ(table.subscribers(kTopics), 1U);
}

TEST(SubscriptionTable, OneReportedEndRemovesRepeatedSubscriptions) {
  SubscriptionTable table;
  for (int k = 0; k < 100; ++k) EXPECT_EQ(table.add({1, 100}, "c"), 1U);
  EXPECT_EQ(table.size(), 1U);
  table.remove(kUnknown, "c");
  EXPECT_EQ(table.size(), 0U);
}

TEST(SubscriptionTable, RemainingTopicsOfAnEndedConnectionAreRemovedLater) {
  SubscriptionTable table;
  table.add({1, 100}, "c");
  table.add({1, 100}, "/a");
  table.add({1, 0}, "c");     // again, read after the end
  table.add({2, 200}, "c");   // is open
  table.add(kUnknown, "/b");  // nobody knows
  const auto is_open = [](const ConnectionId& connection) { return connection.cookie == 200; };
  const auto start = SubscriptionTable::Clock::now();
  table.forget_ended(is_open, start);
  EXPECT_EQ(table.size(), 5U);
  table.forget_ended(is_open, start + SubscriptionTable::kEnd);
  EXPECT_EQ(table.size(), 2U);
  EXPECT_EQ(table.subscribers(kTopics), 2U);
}

TEST(SubscriptionTable, SubscriptionsOfUnknownConnectionsCountOneByOne) {
  SubscriptionTable table;
  table.add(kUnknown, "c");
  table.add(kUnknown, "c");
  table.add(kUnknown, "x");
  EXPECT_EQ(table.subscribers(kTopics), 2U);
  table.remove(kUnknown, "c");
  EXPECT_EQ(table.subscribers(kTopics), 1U);
}

TEST(SubscriptionTable, AnUnmatchedEndChangesNothing) {
  SubscriptionTable table;
  table.remove(kUnknown, "c");
  table.remove({3, 100 + 3}, "c");
  table.add({1, 100 + 1}, "c");
  table.remove(kUnknown, "/a");
  table.remove({1, 100 + 1}, "/a");
  table.remove({3, 100 + 3}, "c");
  EXPECT_EQ(table.subscribers(kTopics), 1U);
}

}  // namespace
}  // namespace glidar::link
