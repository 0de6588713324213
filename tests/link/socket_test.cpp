// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/socket.hpp>
#include "loopback.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <memory>
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

namespace {

/// ZeroMQ holds 1000 events on either side of a monitor's queue; each visit is two of them.
constexpr int kVisits = 1200;

/// Whether a visitor's request is answered.
bool visit(Context& context, const Endpoint& at, Socket& server) {
  constexpr std::array kWord = {std::byte{'?'}};
  Socket visitor(context, {.kind = SocketKind::request});
  visitor.connect(at);
  if (!visitor.send(kWord)) return false;
  constexpr std::chrono::milliseconds kPollInterval{2};
  return testing::soon([&] {
    wait_for({&server}, -1, kPollInterval);
    if (server.receive()) server.send(kWord);
    wait_for({&visitor}, -1, kPollInterval);
    return visitor.receive().has_value();
  });
}

class Visits : public ::testing::TestWithParam<bool> {};

TEST_P(Visits, MayBeManyWhetherOrNotAnybodyAsksForEvents) {
  Context context;
  Endpoint at;
  const auto server = testing::at_free_port([&](const Endpoint& endpoint) {
    at = endpoint;
    auto socket = std::make_unique<Socket>(
        context, SocketOptions{.kind = SocketKind::reply, .reports_events = GetParam()});
    socket->bind(endpoint);
    return socket;
  });
  for (int k = 0; k < kVisits; ++k) ASSERT_TRUE(visit(context, at, *server)) << k;
  std::size_t events = 0;
  if (GetParam()) {  // each came and left
    EXPECT_TRUE(testing::soon([&] { return (events += server->events().size()) == 2U * kVisits; }));
  } else {
    EXPECT_TRUE(server->events().empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Sockets, Visits, ::testing::Bool(), [](const auto& reports_events) {
  return reports_events.param ? "watched" : "unwatched";
});

}  // namespace
}  // namespace glidar::link
