// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/lockstep.hpp>
#include "loopback.hpp"
#include "raw_peer.hpp"

#include <gmock/gmock.h>

#include <memory>
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

namespace {

using testing::RawPeer;
using testing::soon;
using std::chrono_literals::operator""ms;

class LockstepServerTest : public ::testing::Test {
 protected:
  LockstepServerTest() {
    server = testing::at_free_port([&](const link::Endpoint& at) {
      endpoint = at;
      return std::make_unique<Server>(context, options(at), errors);
    });
  }
  /// Connections come as fast as they can here.
  static ServerOptions options(const link::Endpoint& at) {
    return {.endpoint = at, .limits = {.connections_per_s = 1'000'000}};
  }
  link::Socket client() {
    link::Socket socket(context, {.kind = link::SocketKind::request});
    socket.connect(endpoint);
    return socket;
  }
  /// Answers what there is with the number of the request.
  void serve() {
    while (const std::optional<Received> received = server->receive()) {
      server->reply_description(received->to, std::to_string(received->to.id));
    }
  }
  /// Whether this request of the client is answered with its own reply.
  bool is_answered(link::Socket& asking, std::uint64_t id) {
    asking.send(encode(Request(Describe{id})));
    std::vector<std::string> parts;
    const auto has_reply = [&] {
      while (const std::optional<link::Message> part = asking.receive()) {
        parts.emplace_back(reinterpret_cast<const char*>(part->bytes().data()),
                           part->bytes().size());
        if (part->is_last()) return true;
      }
      return false;
    };
    const bool is_replied = soon([&] {  // it pauses between its attempts
      for (int i = 0; i < 1000; ++i) {
        serve();
        if (has_reply()) return true;
        link::wait_for({&server->socket(), &asking}, -1, 10ms);
      }
      return false;
    });
    return is_replied && parts.size() == 2 && parts[1] == std::to_string(id);
  }

  std::vector<std::string> said;
  link::ErrorLog errors{
      {.log = [this](Severity, std::string_view t) { said.emplace_back(t); }, .progress = {}}};
  link::Context context;
  link::Endpoint endpoint;
  std::unique_ptr<Server> server;
};

TEST_F(LockstepServerTest, LosesNoneOf10000RepliesAmongPeersThatSendGarbage) {
  const std::vector<testing::Garbage> garbage = testing::garbage();
  std::vector<link::Socket> steady;
  for (int k = 0; k < 3; ++k) steady.push_back(client());
  std::vector<RawPeer> open;  // some stay for a while
  for (std::uint64_t id = 0; id < 10'000; ++id) {
    if (id % 5 == 0) {
      open.push_back(testing::stranger(endpoint, garbage[id / 5 % garbage.size()]));
      if (open.size() == 10) open.clear();
    }
    if (id % 20 == 0) {
      link::Socket fresh = client();
      ASSERT_TRUE(is_answered(fresh, id));
    } else {
      ASSERT_TRUE(is_answered(steady[id % steady.size()], id));
    }
  }
  EXPECT_GE(server->counts().received, 10'000U);
}

/// A DEALER that sends requests and reads no replies.
class Flooder {
 public:
  explicit Flooder(const link::Endpoint& at) : peer_(at) { EXPECT_TRUE(peer_.shake("DEALER")); }
  void send() {
    const std::vector<std::byte> request = encode(Request(Describe{7}));
    const std::string body(reinterpret_cast<const char*>(request.data()), request.size());
    std::string many;
    for (int k = 0; k < 1000; ++k) {
      many += testing::zmtp_part("", true) + testing::zmtp_part(body, false);
    }
    peer_.send(many);
  }

 private:
  RawPeer peer_;
};

TEST_F(LockstepServerTest, ServesOthersWhileOneClientFloodsItAndReadsNothing) {
  Flooder flooder(endpoint);
  link::Socket asking = client();
  for (std::uint64_t id = 100; id < 300; ++id) {
    flooder.send();
    ASSERT_TRUE(is_answered(asking, id));
  }
  EXPECT_GT(server->counts().refused, 0U);
  EXPECT_GT(errors.counts().at("requests refused"), 0U);
}

TEST_F(LockstepServerTest, DropsTheRequestsOfAClientThatHasLeft) {
  link::Socket asking = client();
  ASSERT_TRUE(is_answered(asking, 1));
  std::optional<Received> received;
  {
    link::Socket leaves = client();
    leaves.send(encode(Request(Describe{2})));
    ASSERT_TRUE(soon([&] { return (received = server->receive()).has_value(); }));
    EXPECT_TRUE(server->is_wanted(received->to));
  }
  EXPECT_TRUE(soon([&] { return !server->is_wanted(received->to); }));
  server->drop(received->to);
  EXPECT_TRUE(is_answered(asking, 3));
}

TEST_F(LockstepServerTest, ReservesMemoryForRepliesUpToTheLimit) {
  constexpr std::int64_t kMib = 1 << 20;
  link::Socket first = client();
  link::Socket second = client();
  std::vector<Received> received;
  for (link::Socket* asking : {&first, &second}) {
    asking->send(encode(Request(Describe{1})));
    ASSERT_TRUE(soon([&] {
      std::optional<Received> one = server->receive();
      if (one) received.push_back(std::move(*one));
      return one.has_value();
    }));
  }
  EXPECT_TRUE(server->reserve(received[0].to, 1500 * kMib));
  EXPECT_TRUE(server->reserve(received[0].to, 1500 * kMib));  // once
  EXPECT_FALSE(server->reserve(received[1].to, 600 * kMib));
  server->reply_description(received[0].to, "done");
  EXPECT_TRUE(soon([&] { return server->reserve(received[1].to, 600 * kMib); }));
  server->drop(received[1].to);
}

}  // namespace
}  // namespace glidar::lockstep
