// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/lockstep/request_queue.hpp>

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace glidar::lockstep {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

link::Delivered from(const std::string& client, int connection = 1) {
  return {.from = {.client = client, .connection = {.descriptor = connection}}, .body = {}};
}

std::string add(RequestQueue& queue, const std::string& client) {
  link::Delivered message = from(client);
  return queue.add(message, {});
}

/// The clients of all that wait, each answered before the next one.
std::vector<std::string> turns(RequestQueue& queue) {
  std::vector<std::string> clients;
  while (const std::optional<Waiting> waiting = queue.next()) {
    clients.push_back(waiting->message.from.client);
    queue.done(clients.back());
  }
  return clients;
}

TEST(RequestQueue, ServesClientsInTurn) {
  RequestQueue queue({});
  for (int k = 0; k < 4; ++k) EXPECT_THAT(add(queue, "flood"), IsEmpty());
  EXPECT_THAT(add(queue, "b"), IsEmpty());
  EXPECT_THAT(add(queue, "c"), IsEmpty());
  EXPECT_THAT(add(queue, "b"), IsEmpty());
  EXPECT_THAT(turns(queue), ElementsAre("flood", "b", "c", "flood", "b", "flood", "flood"));
}

TEST(RequestQueue, AClientHasOneRequestInProgress) {
  RequestQueue queue({});
  add(queue, "a");
  add(queue, "a");
  ASSERT_TRUE(queue.next());
  EXPECT_FALSE(queue.next());
  add(queue, "b");
  EXPECT_EQ(queue.next()->message.from.client, "b");
  queue.done("a");
  EXPECT_EQ(queue.next()->message.from.client, "a");
}

TEST(RequestQueue, RejectsRequestsBeyondTheLimitOfOneClientOnly) {
  RequestQueue queue({.requests = 2});
  add(queue, "a");
  EXPECT_TRUE(queue.next());
  EXPECT_THAT(add(queue, "a"), IsEmpty());
  EXPECT_THAT(add(queue, "a"), ::testing::AllOf(HasSubstr("3 of one client"),
                                                HasSubstr("at most 2 (--limit requests)")));
  EXPECT_THAT(add(queue, "b"), IsEmpty());
  queue.done("a");
  const auto unread = queue.unread_of(from("a").from);
  unread->replies = 1;
  EXPECT_THAT(add(queue, "a"), HasSubstr("--limit requests"));
  unread->replies = 0;
  EXPECT_THAT(add(queue, "a"), IsEmpty());
}

TEST(RequestQueue, RejectsRequestsWhileUnreadRepliesFillTheMemory) {
  RequestQueue queue({.memory_mib = 1});
  queue.all_unread()->bytes = (1 << 20) + 1;
  EXPECT_THAT(add(queue, "a"), HasSubstr("--limit memory-mib"));
}

TEST(RequestQueue, RemovesClientsWithoutRequests) {
  RequestQueue queue({});
  const auto check = [&] {
    queue.check_clients(
        {}, std::chrono::seconds(1), [](const auto&) { return 0; }, [](const auto&) {});
  };
  add(queue, "a");
  check();
  EXPECT_TRUE(queue.has_clients());
  EXPECT_TRUE(queue.next());
  check();
  EXPECT_TRUE(queue.has_clients());
  queue.done("a");
  check();
  EXPECT_FALSE(queue.has_clients());
}

TEST(RequestQueue, FindsClientsThatDoNotReadTheirReplies) {
  RequestQueue queue({});
  const auto reads = queue.unread_of(from("reads", 1).from);
  const auto stalls = queue.unread_of(from("stalls", 2).from);
  reads->replies = stalls->replies = 1;
  std::uint64_t taken = 0;
  std::vector<int> stalled;
  const Clock::time_point start = Clock::now();
  for (int second = 0; second < 4; ++second) {
    queue.check_clients(
        start + std::chrono::seconds(second), std::chrono::seconds(3),
        [&](const link::ConnectionId& client) { return client.descriptor == 1 ? ++taken : 0; },
        [&](const link::ConnectionId& client) { stalled.push_back(client.descriptor); });
  }
  EXPECT_THAT(stalled, ElementsAre(2));
}

}  // namespace
}  // namespace glidar::lockstep
