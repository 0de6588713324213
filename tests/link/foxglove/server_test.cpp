// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/server.hpp>

#include "support/error_text.hpp"
#include "test_server.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

namespace glidar::foxglove {
namespace {

using ::testing::HasSubstr;
using testing::http_answer;
using testing::payload_of;
using testing::soon;
using ::testing::StartsWith;
using testing::TestServer;
using testing::upgrade_request;
using testing::WebSocketPeer;

TEST(FoxgloveServer, AnswersTheExampleHandshakeOfRfc6455) {
  TestServer server;
  const WebSocketPeer client(server.port(), 0,
                             upgrade_request({}, "foxglove.websocket.v1, foxglove.sdk.v1"));
  EXPECT_THAT(client.head(), StartsWith("HTTP/1.1 101"));
  EXPECT_THAT(client.head(), HasSubstr("Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo="));
  EXPECT_THAT(client.head(), HasSubstr("Sec-WebSocket-Protocol: foxglove.sdk.v1"));
  EXPECT_THAT(client.text(), HasSubstr(R"("op":"serverInfo")"));
  EXPECT_THAT(client.text(), HasSubstr(R"("topic":"/points")"));
}

TEST(FoxgloveServer, DeliversMessagesByteForByteToSubscribersOnly) {
  TestServer server;
  const WebSocketPeer subscriber(server.port());
  const WebSocketPeer other(server.port());
  subscriber.subscribe(5, server.channel);
  ASSERT_TRUE(soon([&] { return server.server.is_subscribed(server.channel); }));
  std::string bytes(70'000, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 7);
  server.publish(bytes, 0x0102030405060708);
  EXPECT_EQ(subscriber.message(5), bytes);
  subscriber.send(R"({"op":"unsubscribe","subscriptionIds":[5]})");
  EXPECT_TRUE(soon([&] { return !server.server.is_subscribed(server.channel); }));
  EXPECT_EQ(server.server.counts().sent, 1U);
  EXPECT_EQ(server.server.counts().clients, 2U);
}

TEST(FoxgloveServer, SendsTheNewestMessageToLateSubscribers) {
  TestServer server;
  server.publish("old");
  server.publish("static transforms");
  const WebSocketPeer client(server.port());
  client.subscribe(1, server.channel);
  EXPECT_EQ(client.message(1), "static transforms");
}

TEST(FoxgloveServer, AdvertisesLaterChannelsAndTheTime) {
  TestServer server;
  const WebSocketPeer client(server.port());
  EXPECT_THAT(client.text(), HasSubstr("serverInfo"));
  EXPECT_THAT(client.text(), HasSubstr("/points"));
  server.server.add_channel({.topic = "/tf", .schema_name = "tf2_msgs/msg/TFMessage"});
  EXPECT_THAT(client.text(), HasSubstr("/tf"));
  server.server.publish_time(7);
  EXPECT_EQ(client.receive().body, std::string("\2\7\0\0\0\0\0\0\0", 9));
}

TEST(FoxgloveServer, ReportsWrongSubscriptionsToTheClient) {
  TestServer server;
  const WebSocketPeer client(server.port());
  client.text();
  client.text();
  client.subscribe(1, 99);
  EXPECT_THAT(client.text(), HasSubstr("there is no channel 99"));
  client.subscribe(1, server.channel);
  client.subscribe(2, server.channel);
  EXPECT_THAT(client.text(), HasSubstr("already subscribed"));
  client.send(R"({"op":"getParameters"})");
  EXPECT_THAT(client.text(), HasSubstr("'getParameters' is not supported"));
  client.send(R"({"op":"unsubscribe","subscriptionIds":[8]})");
  EXPECT_THAT(client.text(), HasSubstr("no such subscription"));
}

TEST(FoxgloveServer, GivesSlowClientsTheNewestMessageAndNeverWaitsForThem) {
  TestServer server;
  const ChannelId small =
      server.server.add_channel({.topic = "/tf", .schema_name = "x", .depth = 3});
  constexpr int kSmallBuffer = 4096;
  const WebSocketPeer slow(server.port(), kSmallBuffer);
  slow.subscribe(1, server.channel);
  slow.subscribe(2, small);
  ASSERT_TRUE(soon([&] { return server.server.is_subscribed(small); }));
  constexpr int kMessages = 40;
  const std::string body(std::size_t{8} << 20, 'x');
  for (int i = 0; i <= kMessages; ++i) {
    server.publish(body + std::to_string(i));
    server.server.publish(small, 1, payload_of(std::to_string(i)));
    if (i == 0) continue;  // the first one fills the buffers of the connection
    ASSERT_TRUE(
        soon([&] { return server.server.counts().dropped + 8 >= 2U * static_cast<unsigned>(i); }));
  }
  std::string last_small;
  int large = 0;
  for (std::string got; !got.ends_with("x" + std::to_string(kMessages));) {
    const WebSocketPeer::Frame frame = slow.receive();
    if (frame.opcode != 2) continue;
    got = frame.body;
    large += frame.body.size() > body.size() ? 1 : 0;
    if (frame.body[1] == 2) last_small = frame.body.substr(13);
  }
  EXPECT_LE(large, 4);
  while (last_small != std::to_string(kMessages)) last_small = slow.message(2);
}

TEST(FoxgloveServer, RefusesForeignPagesHostsAndProtocols) {
  TestServer server;
  const auto status = [&](const std::string& request) {
    return http_answer(server.port(), request).substr(0, 12);
  };
  EXPECT_EQ(status(upgrade_request("Origin: https://attacker.example\r\n")), "HTTP/1.1 403");
  EXPECT_EQ(status(upgrade_request({}, "foxglove.sdk.v1", "attacker.example")), "HTTP/1.1 403");
  EXPECT_EQ(status(upgrade_request({}, "chat")), "HTTP/1.1 400");
  const WebSocketPeer viewer(server.port(), 0,
                             upgrade_request("Origin: https://app.foxglove.dev\r\n"));
  EXPECT_THAT(viewer.head(), StartsWith("HTTP/1.1 101"));
}

TEST(FoxgloveServer, ServesThePageWithAStrictPolicy) {
  TestServer server;
  const std::string page = http_answer(server.port(), testing::get_request("/"));
  EXPECT_THAT(page, StartsWith("HTTP/1.1 200 OK"));
  EXPECT_THAT(page, HasSubstr("Content-Security-Policy: default-src 'none'; script-src 'self'"));
  EXPECT_THAT(page, HasSubstr("<title>GLIDAR"));
  EXPECT_THAT(http_answer(server.port(), testing::get_request("/nothing")),
              StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(http_answer(server.port(), "HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n"),
              ::testing::Not(HasSubstr("<title>")));
}

/// What the page of this server sends.
std::string own_post(const TestServer& server, const std::string& target, const std::string& body) {
  const std::string host = "127.0.0.1:" + std::to_string(server.port());
  return http_answer(server.port(), testing::post_request(target, body, "http://" + host, host));
}

TEST(FoxgloveServer, PassesCommandsOnAndPublishesTheState) {
  std::atomic<int> steps = 0;
  TestServer server({.on_playback = [&](PlaybackCommand command) {
    steps += command == PlaybackCommand::step ? 1 : 0;
  }});
  EXPECT_THAT(own_post(server, "/api/playback", R"({"command":"step"})"), HasSubstr("200 OK"));
  EXPECT_EQ(steps, 1);
  EXPECT_THAT(own_post(server, "/api/playback", "{"), HasSubstr("400"));
  server.server.set_playback({.is_playing = false, .time_ns = 3});
  const WebSocketPeer client(server.port());
  EXPECT_THAT(client.text(), HasSubstr(R"("glidar.playback":"true")"));
  client.subscribe(1, 1);
  EXPECT_EQ(client.message(1), R"({"playing":false,"time_ns":"3"})");
}

constexpr const char* kPick = R"({"topic":"/points","time_ns":"5","index":7})";

TEST(FoxgloveServer, ReturnsTheExplanationOfAPoint) {
  Pick asked;
  TestServer server({.on_pick = [&](const Pick& pick, const PickReply& reply) {
    asked = pick;
    std::thread([reply] { reply("a wall"); }).detach();
  }});
  EXPECT_THAT(own_post(server, "/api/pick", kPick), HasSubstr(R"({"text":"a wall"})"));
  EXPECT_EQ(asked, (Pick{"/points", 5, 7}));
}

TEST(FoxgloveServer, ReportsPointsWithoutExplanation) {
  TestServer server({.on_pick = [](const Pick&, const PickReply&) {}});
  EXPECT_THAT(own_post(server, "/api/pick", kPick), HasSubstr("no explanation of this point"));
}

TEST(FoxgloveServer, EndsWhilePointsWaitForTheirExplanation) {
  std::mutex mutex;
  std::optional<PickReply> late;
  std::optional<TestServer> server(
      std::in_place, ServerOptions{.on_pick = [&](const Pick&, const PickReply& reply) {
        const std::lock_guard lock(mutex);
        late = reply;
      }});
  const testing::TcpPeer page(server->port());
  page.send(testing::post_request("/api/pick", kPick, "http://localhost", "localhost"));
  ASSERT_TRUE(soon([&] {
    const std::lock_guard lock(mutex);
    return late.has_value();
  }));
  server.reset();
  (*late)("too late");
  EXPECT_EQ(page.receive_all(), "");
}

TEST(FoxgloveServer, ReportsThatItsPortIsInUse) {
  TestServer server;
  link::ErrorLog errors{{}};
  ServerOptions options;
  options.at.port = server.port();
  EXPECT_THAT(error_text([&] { FoxgloveServer second(options, errors); }),
              HasSubstr("choose another port"));
  options.at.host = "no such host";
  EXPECT_THAT(error_text([&] { FoxgloveServer second(options, errors); }),
              HasSubstr("find the address"));
}

}  // namespace
}  // namespace glidar::foxglove
