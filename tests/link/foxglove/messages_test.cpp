// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/protocol.hpp>

#include "support/error_text.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

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

}  // namespace
}  // namespace glidar::foxglove
