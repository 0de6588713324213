// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/connection_guard.hpp>

#include <glidar/io/files/unique_fd.hpp>
#include <glidar/link/socket.hpp>

#include "loopback.hpp"
#include "message_bytes.hpp"
#include "raw_peer.hpp"
#include "support/error_text.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <string>

namespace glidar::link {
namespace {

using ::testing::HasSubstr;
using testing::MessageBytes;
using testing::RawPeer;
using testing::soon;

class ConnectionGuardTest : public ::testing::Test {
 protected:
  void listen(const ConnectionLimits& limits) {
    router = testing::at_free_port([&](const Endpoint& at) {
      endpoint = at;
      auto made = std::make_unique<Router>(
          context, SocketOptions{.protection = Protection{limits, errors}}, errors);
      made->bind(at);
      return made;
    });
  }
  /// Whether a new client is answered, however long that takes.
  bool serves_a_new_client() {
    Socket client(context, {.kind = SocketKind::request});
    client.connect(endpoint);
    client.send(MessageBytes().text("x").bytes);
    return soon([&] {
      while (const std::optional<Delivered> request = router->receive()) {
        const std::vector<Part> parts = {part_of("y")};
        router->reply(request->from, parts);
      }
      return client.receive().has_value();
    });
  }
  bool becomes_fault(const std::string& kind) {
    return soon([&] { return errors.counts().count(kind) > 0; });
  }
  std::string said(const std::string& kind) {
    const std::lock_guard lock(mutex);
    for (const std::string& text : texts) {
      if (text.starts_with(kind)) return text;
    }
    return "";
  }

  std::mutex mutex;  // errors are reported by another thread
  std::vector<std::string> texts;
  ErrorLog errors{{.log =
                       [this](Severity, std::string_view t) {
                         const std::lock_guard lock(mutex);
                         texts.emplace_back(t);
                       },
                   .progress = {}}};
  Context context;
  Endpoint endpoint;
  std::unique_ptr<Router> router;
};

/// A connected socket with this descriptor.
void connect_at(int descriptor) {
  std::array<int, 2> pair{};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, pair.data()), 0);
  ASSERT_EQ(::dup2(pair[0], descriptor), descriptor);
  ::close(pair[0]);
  ::close(pair[1]);
}

TEST_F(ConnectionGuardTest, KeepsAConnectionWhoseDescriptorIsReportedClosedLate) {
  const UniqueFd place(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  ConnectionGuard guard({}, errors);
  connect_at(place.get());
  guard.on_accepted(place.get());
  const ConnectionId first{place.get(), guard.delivered(place.get())};
  connect_at(place.get());
  guard.on_accepted(place.get());
  const ConnectionId second{place.get(), guard.delivered(place.get())};
  guard.on_left(place.get());  // the first one
  EXPECT_FALSE(guard.is_open(first));
  EXPECT_TRUE(guard.is_open(second));
  EXPECT_TRUE(guard.needs_check());
}

TEST_F(ConnectionGuardTest, CutsOffAMessageThatNeverEndsAndServesOthers) {
  listen({.unread_bytes = 100'000});
  const RawPeer endless(endpoint);
  ASSERT_TRUE(endless.shake("DEALER"));
  std::string parts;
  for (int k = 0; k < 1000; ++k) parts += testing::zmtp_part("x", true);
  EXPECT_TRUE(soon([&] {
    endless.send(parts);
    return endless.is_closed();
  }));
  EXPECT_TRUE(becomes_fault("peer cut off"));
  EXPECT_THAT(said("peer cut off"), HasSubstr("allowed are 100000"));
  EXPECT_TRUE(serves_a_new_client());
}

TEST_F(ConnectionGuardTest, CutsOffTheLargestSenderWhenAllExceedTheLimit) {
  listen({.unread_bytes = 1 << 20, .all_unread_bytes = 1 << 20});
  std::vector<RawPeer> peers;
  for (int k = 0; k < 8; ++k) {
    ASSERT_TRUE(peers.emplace_back(endpoint).shake("DEALER"));
    ASSERT_TRUE(peers.back().send(testing::zmtp_part(std::string(100 + k, 'x'), true)));
  }
  const std::string part = std::string("\1\xff", 2) + std::string(255, 'x');
  std::string parts;
  for (int k = 0; k < 700; ++k) parts += part;  // 180 kB
  for (const RawPeer& peer : peers) peer.send(parts);
  EXPECT_TRUE(becomes_fault("peer cut off"));
  EXPECT_TRUE(serves_a_new_client());
}

TEST_F(ConnectionGuardTest, DoesNotCountDeliveredBytes) {
  listen({.unread_bytes = 10'000, .all_unread_bytes = 10'000});
  const RawPeer steady(endpoint);
  ASSERT_TRUE(steady.shake("DEALER"));
  const std::string message =
      testing::zmtp_part("", true) + testing::zmtp_part(std::string(200, 'x'), false);
  for (int k = 0; k < 500; ++k) {
    ASSERT_TRUE(steady.send(message));
    ASSERT_TRUE(soon([&] { return router->receive().has_value(); }));
  }
  EXPECT_FALSE(steady.is_closed());
  EXPECT_TRUE(errors.counts().empty());
}

TEST_F(ConnectionGuardTest, CountsDeliveredBytesIfConfigured) {
  listen({.unread_bytes = 10'000, .free_bytes_per_s = 0.0, .counts_delivered = true});
  const RawPeer talker(endpoint);
  ASSERT_TRUE(talker.shake("DEALER"));
  const std::string message =
      testing::zmtp_part("", true) + testing::zmtp_part(std::string(200, 'x'), false);
  EXPECT_TRUE(soon([&] {
    talker.send(message);
    while (router->receive()) {
    }
    return talker.is_closed();
  }));
  EXPECT_TRUE(becomes_fault("peer cut off"));
  EXPECT_THAT(said("peer cut off"), HasSubstr("bytes; allowed are 10000"));
  EXPECT_TRUE(serves_a_new_client());
}

TEST_F(ConnectionGuardTest, DropsUnreadBytesOfAPeerThatIsCutOff) {
  const UniqueFd listener(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  ASSERT_EQ(::bind(listener.get(), any, size), 0);
  ASSERT_EQ(::listen(listener.get(), 1), 0);
  ASSERT_EQ(::getsockname(listener.get(), any, &size), 0);
  const RawPeer peer({"127.0.0.1", ntohs(address.sin_port)});
  const UniqueFd accepted(::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC));
  ConnectionGuard guard({}, errors);
  guard.on_accepted(accepted.get());
  ASSERT_TRUE(peer.send(std::string(1000, 'x')));
  char byte = 0;
  ASSERT_EQ(::recv(accepted.get(), &byte, 1, 0), 1);  // the others are here too
  guard.cut_off({accepted.get(), 0}, "test error", "because");
  EXPECT_LE(::recv(accepted.get(), &byte, 1, MSG_DONTWAIT), 0);
  EXPECT_TRUE(soon([&] { return peer.is_closed(); }));
}

TEST_F(ConnectionGuardTest, MessagesAfterTheEndDoNotRestoreAConnection) {
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
  const UniqueFd other(ends[1]);
  ConnectionGuard guard({}, errors);
  guard.on_accepted(ends[0]);
  guard.cut_off({ends[0], 0}, "test error", "because");
  ::close(ends[0]);
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(guard.delivered(ends[0]), 0U);
    guard.cut_off({ends[0], 0}, "test error", "because");
  }
  EXPECT_EQ(errors.counts().at("test error"), 1U);
}

TEST_F(ConnectionGuardTest, IdleConnectionsDoNotBlockANewClient) {
  listen({.connections = 8, .connections_per_s = 1000.0});
  std::vector<RawPeer> idle;
  for (int k = 0; k < 40; ++k) idle.emplace_back(endpoint);
  EXPECT_TRUE(serves_a_new_client());
  EXPECT_TRUE(becomes_fault("connection limit"));
  EXPECT_THAT(said("connection limit"), HasSubstr("at most 8 connections"));
  EXPECT_TRUE(soon([&] {
    return std::count_if(idle.begin(), idle.end(),
                         [](const RawPeer& peer) { return !peer.is_closed(); }) <= 8;
  }));
}

TEST_F(ConnectionGuardTest, AClientThatWasServedKeepsItsConnection) {
  listen({.connections = 4, .connections_per_s = 1000.0});
  const RawPeer client(endpoint);
  ASSERT_TRUE(client.shake("DEALER"));
  client.send(testing::zmtp_part("", true) + testing::zmtp_part("x", false));
  ASSERT_TRUE(soon([&] { return router->receive().has_value(); }));
  std::vector<RawPeer> idle;
  for (int k = 0; k < 40; ++k) idle.emplace_back(endpoint);
  EXPECT_TRUE(serves_a_new_client());
  EXPECT_FALSE(client.is_closed());
}

TEST_F(ConnectionGuardTest, DelaysConnectionsAboveTheRateLimit) {
  listen({.connections = 20, .connections_per_s = 10.0});
  for (int k = 0; k < 30; ++k) {
    ASSERT_TRUE(serves_a_new_client()) << k;
  }
  EXPECT_TRUE(becomes_fault("connection rate"));
  EXPECT_THAT(said("connection rate"), HasSubstr("--limit connections-per-s"));
}

TEST_F(ConnectionGuardTest, KnowsWhetherAConnectionIsOpenAndWhatItsPeerHasReceived) {
  listen({});
  auto client = std::make_unique<Socket>(context, SocketOptions{.kind = SocketKind::request});
  client->connect(endpoint);
  client->send(MessageBytes().text("x").bytes);
  std::optional<Delivered> request;
  ASSERT_TRUE(soon([&] { return (request = router->receive()).has_value(); }));
  const ConnectionId connection = request->from.connection;
  EXPECT_NE(connection.cookie, 0U);
  EXPECT_TRUE(router->socket().is_open(connection));
  const std::uint64_t before = router->socket().taken_bytes(connection);
  const std::vector<Part> parts = {part_of(std::string(1000, 'y'))};
  ASSERT_EQ(router->reply(request->from, parts), Sending::sent);
  EXPECT_TRUE(soon([&] { return router->socket().taken_bytes(connection) >= before + 1000; }));
  client.reset();
  EXPECT_TRUE(soon([&] { return !router->socket().is_open(connection); }));
  EXPECT_FALSE(router->socket().is_open({connection.descriptor, connection.cookie + 1}));
}

using ::testing::AllOf;

std::string refusal(const std::string& text) {
  Limits limits;
  std::string error = error_text([&] { set_limit(limits, text); });
  EXPECT_EQ(limits, Limits{});
  return error;
}

TEST(Limits, EachIsSetByItsNameWithinItsRange) {
  for (const LimitKind& kind : limit_kinds()) {
    Limits limits;
    EXPECT_GE(limits.*kind.value, kind.min) << kind.name;
    EXPECT_LE(limits.*kind.value, kind.max) << kind.name;
    for (const std::int64_t value : {kind.min, kind.max}) {
      set_limit(limits, std::string(kind.name) + "=" + std::to_string(value));
      EXPECT_EQ(limits.*kind.value, value) << kind.name;
    }
    limits.*kind.value = Limits{}.*kind.value;
    EXPECT_EQ(limits, Limits{}) << kind.name;
    EXPECT_THAT(limit_text(limits, kind.value), HasSubstr(std::string(kind.name)));
  }
}

TEST(Limits, AnUnknownNameIsAnErrorWithTheClosestMatch) {
  EXPECT_THAT(refusal("reply-mb=4"), AllOf(HasSubstr("--limit"), HasSubstr("'reply-mb=4'"),
                                           HasSubstr("did you mean reply-mib?")));
  EXPECT_THAT(refusal(""), HasSubstr("connections, connections-per-s"));
}

TEST(Limits, AnInvalidValueIsAnErrorWithRangeAndExample) {
  for (const char* value : {"=0", "=-1", "=1.5", "=many", "=", "", "=1000001", "=4 "}) {
    EXPECT_THAT(refusal("requests" + std::string(value)),
                AllOf(HasSubstr("--limit requests"), HasSubstr("from 1 to 1000000"),
                      HasSubstr("for example --limit requests=16")))
        << value;
  }
}

}  // namespace

}  // namespace glidar::link
