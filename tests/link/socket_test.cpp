// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/socket.hpp>

#include "loopback.hpp"
#include "message_bytes.hpp"
#include "raw_peer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <fstream>
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

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::MessageBytes;
using testing::RawPeer;
using testing::soon;

class RouterTest : public ::testing::Test {
 protected:
  RouterTest() {
    router = testing::at_free_port([&](const Endpoint& at) {
      endpoint = at;
      auto made = std::make_unique<Router>(context, SocketOptions{}, errors);
      made->bind(at);
      return made;
    });
  }
  Socket client() {
    Socket socket(context, {.kind = SocketKind::request});
    socket.connect(endpoint);
    return socket;
  }
  Delivered delivered() {
    std::optional<Delivered> found;
    EXPECT_TRUE(soon([&] { return (found = router->receive()).has_value(); }));
    return std::move(*found);
  }
  Sending reply(const Delivered& request, const std::string& text) {
    const std::vector<Part> parts = {part_of(text)};
    return router->reply(request.from, parts);
  }
  static std::string text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  /// A peer that is none of ZeroMQ's.
  RawPeer dealer(const std::string& parts) const {
    RawPeer peer(endpoint);
    EXPECT_TRUE(peer.shake("DEALER"));
    EXPECT_TRUE(peer.send(parts));
    return peer;
  }

  std::vector<std::string> said;
  ErrorLog errors{
      {.log = [this](Severity, std::string_view t) { said.emplace_back(t); }, .progress = {}}};
  Context context;
  Endpoint endpoint;
  std::unique_ptr<Router> router;
};

TEST_F(RouterTest, RepliesInAnyOrderReachTheirClients) {
  Socket first = client();
  Socket second = client();
  first.send(MessageBytes().text("first").bytes);
  const Delivered one = delivered();
  second.send(MessageBytes().text("second").bytes);
  const Delivered two = delivered();
  EXPECT_EQ(text_of(one.body.bytes()), "first");
  EXPECT_NE(one.from.client, two.from.client);
  EXPECT_GE(one.from.connection.descriptor, 0);
  EXPECT_EQ(reply(two, "to the second"), Sending::sent);
  EXPECT_EQ(reply(one, "to the first"), Sending::sent);
  EXPECT_EQ(text_of(testing::received(first)), "to the first");
  EXPECT_EQ(text_of(testing::received(second)), "to the second");
}

TEST_F(RouterTest, ReturnsTheEnvelopeOfARequest) {
  using testing::zmtp_part;
  const RawPeer peer =
      dealer(zmtp_part("number", true) + zmtp_part("", true) + zmtp_part("body", false));
  const Delivered request = delivered();
  EXPECT_THAT(request.from.envelope, ElementsAre("number"));
  EXPECT_EQ(text_of(request.body.bytes()), "body");
  EXPECT_TRUE(request.is_single);
}

TEST_F(RouterTest, ReportsThatABodyHasSeveralParts) {
  using testing::zmtp_part;
  const RawPeer peer = dealer(zmtp_part("", true) + zmtp_part("body", true) + zmtp_part("", true) +
                              zmtp_part("more", false));
  const Delivered request = delivered();
  EXPECT_EQ(text_of(request.body.bytes()), "body");
  EXPECT_FALSE(request.is_single);
}

TEST_F(RouterTest, DiscardsAndReportsAMessageWithoutADelimiterOrBody) {
  using testing::zmtp_part;
  std::string many;
  for (int k = 0; k < 9; ++k) many += zmtp_part("x", true);
  const std::string longest(255, 'x');
  const RawPeer peer =
      dealer(zmtp_part("x", false) + zmtp_part("", false) + zmtp_part("x", true) +
             zmtp_part("y", false) + many + zmtp_part("", true) + zmtp_part("body", false) +
             zmtp_part(longest, true) + zmtp_part("", true) + zmtp_part("good", false));
  EXPECT_EQ(text_of(delivered().body.bytes()), "good");
  EXPECT_EQ(errors.counts().at("message discarded"), 4U);
  EXPECT_THAT(said.at(0), HasSubstr("use a REQ socket"));
}

TEST_F(RouterTest, AReplyToAClientThatLeftIsNotSent) {
  Socket stays = client();
  Delivered request;
  {
    Socket leaves = client();
    leaves.send(MessageBytes().text("x").bytes);
    request = delivered();
  }
  EXPECT_TRUE(soon([&] { return reply(request, "late") == Sending::peer_gone; }));
  stays.send(MessageBytes().text("y").bytes);
  EXPECT_EQ(reply(delivered(), "in time"), Sending::sent);
  EXPECT_EQ(text_of(testing::received(stays)), "in time");
}

TEST_F(RouterTest, AClientThatReadsNoRepliesDoesNotBlockOthers) {
  const std::string request = testing::zmtp_part("", true) + testing::zmtp_part("x", false);
  const RawPeer deaf = dealer(request);
  const Delivered asked = delivered();
  const std::string large(1 << 20, 'x');
  EXPECT_TRUE(soon([&] { return reply(asked, large) == Sending::queue_full; }));
  Socket reads = client();
  reads.send(MessageBytes().text("y").bytes);
  EXPECT_EQ(reply(delivered(), "in time"), Sending::sent);
  EXPECT_EQ(text_of(testing::received(reads)), "in time");
}

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
