// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/protocol.hpp>

#include "support/error_text.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <variant>
#include <vector>

namespace glidar::foxglove {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(FoxgloveMessages, PreferTheNewerOfTheOfferedSubprotocols) {
  EXPECT_EQ(choose_subprotocol("foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(choose_subprotocol("x, foxglove.websocket.v1 ,\tfoxglove.sdk.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(choose_subprotocol("foxglove.websocket.v2,,"), "");
  EXPECT_EQ(choose_subprotocol(""), "");
}

TEST(FoxgloveMessages, DescribeServerAndChannelsAsTheProtocolSpecifies) {
  const auto info = nlohmann::json::parse(
      server_info_text({.name = "GLIDAR", .session_id = "7", .metadata = {{"a", "b"}}}));
  EXPECT_EQ(info, nlohmann::json::parse(R"({"op":"serverInfo","name":"GLIDAR",
      "capabilities":["time"],"supportedEncodings":["cdr"],"metadata":{"a":"b"},"sessionId":"7"})"));
  const Channel channel{.id = 3,
                        .topic = "/points",
                        .encoding = "cdr",
                        .schema_name = "sensor_msgs/msg/PointCloud2",
                        .schema = "uint8[] data\n",
                        .schema_encoding = "ros2msg"};
  EXPECT_EQ(nlohmann::json::parse(advertise_text({&channel, 1})),
            nlohmann::json::parse(R"({"op":"advertise","channels":[{"id":3,"topic":"/points",
      "encoding":"cdr","schemaName":"sensor_msgs/msg/PointCloud2","schema":"uint8[] data\n",
      "schemaEncoding":"ros2msg"}]})"));
  EXPECT_EQ(status_text(StatusLevel::error, "bad \xff"),
            "{\"level\":2,\"message\":\"bad \xEF\xBF\xBD\",\"op\":\"status\"}");
}

TEST(FoxgloveMessages, DecodeSubscriptions) {
  const auto begin = decode_client_message(
      R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":4294967295,"channelId":5}]})");
  EXPECT_THAT(std::get<Subscribe>(begin).subscriptions,
              ElementsAre(Subscription{0, 3}, Subscription{4294967295U, 5}));
  const auto end = decode_client_message(R"({"op":"unsubscribe","subscriptionIds":[1,2]})");
  EXPECT_THAT(std::get<Unsubscribe>(end).subscriptions, ElementsAre(1U, 2U));
  EXPECT_EQ(std::get<Unsupported>(decode_client_message(R"({"op":"getParameters"})")).operation,
            "getParameters");
}

TEST(FoxgloveMessages, RejectEverythingElse) {
  for (const char* text :
       {"", "[]", "{", "1e999", "{}", R"({"op":1})", R"({"op":"subscribe"})",
        R"({"op":"subscribe","subscriptions":{}})", R"({"op":"subscribe","subscriptions":[1]})",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":3}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1.5,"channelId":3}]})",
        R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":3}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1}]})",
        R"({"op":"unsubscribe","subscriptionIds":["1"]})"}) {
    EXPECT_THROW(decode_client_message(text), Error) << text;
  }
  EXPECT_THROW(decode_client_message(std::string(60000, '[')), Error);
  std::string many = R"({"op":"unsubscribe","subscriptionIds":[1)";
  for (std::size_t i = 0; i < kMaxSubscriptions; ++i) many += ",1";
  EXPECT_THAT(error_text([&] { decode_client_message(many + "]}"); }), HasSubstr("at most 1024"));
}

TEST(FoxgloveMessages, HaveLittleEndianHeads) {
  EXPECT_THAT(message_head(0x01020304, 0x0807060504030201),
              ElementsAre(std::byte{1}, std::byte{4}, std::byte{3}, std::byte{2}, std::byte{1},
                          std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}, std::byte{5},
                          std::byte{6}, std::byte{7}, std::byte{8}));
  EXPECT_EQ(time_message(1)[0], std::byte{2});
  EXPECT_EQ(time_message(1)[1], std::byte{1});
}

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

HttpReply reply_to(const HttpRequest& request, const PageServices& services = {true, true}) {
  link::HttpGuard guard({}, link::HttpClients::own_pages);
  return std::get<HttpReply>(route(request, guard, services));
}

TEST(HttpRoutes, ServeEveryFileOfThePage) {
  for (const PageFile& file : page_files()) {
    const HttpReply reply = reply_to({{"GET", "localhost"}, file.target});
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(reply.content_type, file.content_type);
    EXPECT_THAT(reply.body, HasSubstr("SPDX-License-Identifier: BSD-3-Clause")) << file.target;
  }
  EXPECT_EQ(reply_to({{"GET", "localhost"}, "/?layout=1"}).status, 200);
  for (const char* target : {"", "/x", "//", "/../etc/passwd", "/main.js/", "main.js"}) {
    EXPECT_EQ(reply_to({{"GET", "localhost"}, target}).status, 404) << target;
  }
  EXPECT_EQ(reply_to({{"GET", "attacker.example"}, "/"}).status, 403);
  EXPECT_EQ(reply_to({{"PUT", "localhost"}, "/"}).status, 405);
}

TEST(HttpRoutes, AcceptCommandsFromTheServersOwnPageOnly) {
  link::HttpGuard guard({}, link::HttpClients::own_pages);
  HttpRequest request{{"POST", "localhost:1", "http://localhost:1"},
                      "/api/playback",
                      "application/json",
                      R"({"command":"step"})"};
  EXPECT_EQ(std::get<PlaybackCommand>(route(request, guard, {true, true})), PlaybackCommand::step);
  EXPECT_EQ(reply_to(request, {.has_playback = false, .has_picks = true}).status, 404);
  for (const char* origin : {"", "null", "http://localhost:2", "https://app.foxglove.dev"}) {
    request.head.origin = origin;
    EXPECT_EQ(reply_to(request).status, 403) << origin;
  }
  request.head.origin = "http://localhost:1";
  request.content_type = "text/plain";
  EXPECT_EQ(reply_to(request).status, 415);
}

TEST(HttpRoutes, DecodePicks) {
  link::HttpGuard guard({}, link::HttpClients::own_pages);
  HttpRequest request{{"POST", "localhost:1", "http://localhost:1"},
                      "/api/pick",
                      "application/json",
                      R"({"topic":"/points","time_ns":"18446744073709551615","index":7})"};
  EXPECT_EQ(std::get<Pick>(route(request, guard, {true, true})),
            (Pick{"/points", 18446744073709551615U, 7}));
  for (const char* body :
       {"", "{}", R"({"topic":"/points","time_ns":1,"index":7})",
        R"({"topic":"/points","time_ns":"-1","index":7})",
        R"({"topic":"/points","time_ns":"","index":7})",
        R"({"topic":"/points","time_ns":"18446744073709551616","index":7})",
        R"({"topic":"/points","time_ns":"1","index":4294967296})", R"({"command":"stop"})"}) {
    request.body = body;
    EXPECT_EQ(reply_to(request).status, 400) << body;
  }
}

TEST(PageMessages, StateTheTimesOfAReplay) {
  EXPECT_EQ(playback_state_text({.is_playing = false, .time_ns = 5, .first_ns = 1, .last_ns = 9}),
            R"({"first_ns":"1","last_ns":"9","playing":false,"time_ns":"5"})");
  EXPECT_THAT(error_text([] { decode_playback_command(R"({"command":"stop"})"); }),
              HasSubstr("play, pause, step"));
}

}  // namespace

}  // namespace glidar::foxglove
