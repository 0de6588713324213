// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/ros_channels.hpp>

#include "support/error_text.hpp"
#include "test_server.hpp"

#include <gmock/gmock.h>

namespace glidar::foxglove {
namespace {

using ::testing::HasSubstr;
using testing::soon;
using testing::TestServer;
using testing::WebSocketPeer;

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(RosChannels, AdvertiseTheDefinitionAndDeliverCdr) {
  TestServer server;
  RosChannels channels(server.server, false);
  const std::size_t topic = channels.add_topic(ros::make_topic<ros::Odometry>("/odom"));
  const WebSocketPeer client(server.port());
  EXPECT_THAT(client.text(), HasSubstr("serverInfo"));
  const std::string advertised = client.text();
  EXPECT_THAT(advertised, HasSubstr(R"("topic":"/odom")"));
  EXPECT_THAT(advertised, HasSubstr(R"("schemaName":"nav_msgs/msg/Odometry")"));
  EXPECT_THAT(advertised, HasSubstr("MSG: geometry_msgs/PoseWithCovariance"));
  client.subscribe(3, 2);  // after the server's own channel
  ASSERT_TRUE(soon([&] { return channels.is_wanted(topic); }));
  ros::Odometry odometry;
  odometry.child_frame_id = "base_link";
  ros::write_message(channels, topic, 5, odometry);
  EXPECT_EQ(client.message(3), text_of(ros::serialize(odometry)));
}

TEST(RosChannels, NeedNoMessagesWithoutSubscribersUnlessTheNewestIsKept) {
  TestServer server;
  RosChannels lazy(server.server, false);
  EXPECT_FALSE(lazy.is_wanted(lazy.add_topic(ros::make_topic<ros::Clock>("/lazy"))));
  RosChannels keeping(server.server, true);
  const std::size_t topic = keeping.add_topic(ros::make_topic<ros::Clock>("/kept"));
  EXPECT_TRUE(keeping.is_wanted(topic));
  ros::write_message(keeping, topic, 7, ros::Clock{{0, 7}});
  const WebSocketPeer late(server.port());
  late.subscribe(3, 3);
  EXPECT_EQ(late.message(3), text_of(ros::serialize(ros::Clock{{0, 7}})));
}

TEST(RosChannels, RefuseTimesBefore1970) {
  TestServer server;
  RosChannels channels(server.server, false);
  const std::size_t topic = channels.add_topic(ros::make_topic<ros::Clock>("/clock"));
  EXPECT_THAT(error_text([&] { ros::write_message(channels, topic, -1, ros::Clock{}); }),
              HasSubstr("since 1970"));
}

}  // namespace
}  // namespace glidar::foxglove
