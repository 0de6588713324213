// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "participants.hpp"

#include <glidar/link/dds/domain.hpp>
#include <glidar/link/dds/message_sink.hpp>

#include <io/ros/sample_messages.hpp>

#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

namespace glidar::dds {
namespace {

using testing::cdr;
using testing::is_matched;
using testing::Participants;
using testing::payload_of;
using testing::reader_of;
using testing::writer_of;

std::optional<link::Payload> next(TopicReader& reader, const WakeUp& wake_up) {
  return testing::wait_for(wake_up.descriptor(), [&] {
    wake_up.clear();
    return reader.take();
  });
}

TEST(DdsTopics, MessagesOfEveryTypeArriveByteForByte) {
  const Participants two;
  ros::for_all_messages(3, [&](const auto& message) {
    using Message = std::decay_t<decltype(message)>;
    const WakeUp wake_up;
    TopicReader reader = reader_of<Message>(two.others, "/topic", wake_up);
    TopicWriter writer = writer_of<Message>(two.ours, "/topic");
    ASSERT_TRUE(is_matched(writer));
    ASSERT_TRUE(writer.write(payload_of(message)));
    const auto received = next(reader, wake_up);
    ASSERT_TRUE(received);
    EXPECT_TRUE(std::ranges::equal(received->bytes(), cdr(message)));
  });
}

TEST(DdsTopics, LateReadersReceiveTheLastMessageOfTransientLocalTopics) {
  const Participants two;
  const ros::MessageType& type = ros::message_type<ros::TFMessage>();
  TopicWriter writer(two.ours, "/tf_static", type, ros::kStaticTransformQos);
  const ros::TFMessage last{{testing::transform("map", "base", 2, {})}};
  writer.write(payload_of(ros::TFMessage{}));
  writer.write(payload_of(last));
  const WakeUp wake_up;
  TopicReader reader(two.others, {"/tf_static", type, {.transient_local = true, .depth = 100}},
                     wake_up);
  const auto received = next(reader, wake_up);
  ASSERT_TRUE(received);
  EXPECT_TRUE(std::ranges::equal(received->bytes(), cdr(last)));
}

TEST(DdsTopics, AReaderThatDoesNotReadGetsTheNewestMessages) {
  const Participants two;
  const WakeUp wake_up;
  TopicReader reader = reader_of<ros::PointCloud2>(two.others, "/points", wake_up);
  TopicWriter writer = writer_of<ros::PointCloud2>(two.ours, "/points");
  ASSERT_TRUE(is_matched(writer));
  constexpr std::uint32_t kMessages = 100;
  for (std::uint32_t i = 0; i < kMessages; ++i)
    ASSERT_TRUE(writer.write(payload_of(ros::sample<ros::PointCloud2>(i))));
  for (std::uint32_t i = kMessages - 5; i < kMessages; ++i) {
    const auto received = next(reader, wake_up);
    ASSERT_TRUE(received);
    EXPECT_TRUE(std::ranges::equal(received->bytes(), cdr(ros::sample<ros::PointCloud2>(i))));
  }
  EXPECT_EQ(writer.count(), kMessages);
}

TEST(DdsTopics, AParticipantDoesNotReceiveItsOwnMessages) {
  const Participants two;
  const WakeUp own_wake_up;
  const WakeUp wake_up;
  TopicReader own = reader_of<ros::Odometry>(two.ours, "/odom", own_wake_up);
  TopicReader reader = reader_of<ros::Odometry>(two.others, "/odom", wake_up);
  TopicWriter writer = writer_of<ros::Odometry>(two.ours, "/odom");
  ASSERT_TRUE(is_matched(writer));
  writer.write(payload_of(testing::odometry(1, {})));
  ASSERT_TRUE(next(reader, wake_up));
  EXPECT_FALSE(own.take());
}

TEST(DdsTopics, DiscardsMessagesAboveTheLimitAndContinues) {
  const Participants two;
  const WakeUp wake_up;
  const ros::MessageType& type = ros::message_type<ros::TFMessage>();
  TopicReader reader(two.others, {"/tf", type, type.qos, 1000}, wake_up);
  TopicWriter writer = writer_of<ros::TFMessage>(two.ours, "/tf");
  ASSERT_TRUE(is_matched(writer));
  const ros::TFMessage huge{
      {testing::transform(std::string(kMaxPoseMessage_bytes, 'a'), "b", 1, {})}};
  const ros::TFMessage small{{testing::transform("a", "b", 1, {})}};
  writer.write(payload_of(huge));
  writer.write(payload_of(small));
  const auto received = next(reader, wake_up);
  ASSERT_TRUE(received);
  EXPECT_TRUE(std::ranges::equal(received->bytes(), cdr(small)));
}

TEST(DdsTopics, ReleasesTheMemoryOfOldMessages) {
  const Participants two;
  TopicWriter writer = writer_of<ros::PointCloud2>(two.ours, "/points");
  const link::Payload payload = payload_of(ros::sample<ros::PointCloud2>(1));
  const std::weak_ptr<std::byte[]> memory = payload.memory;  // NOLINT
  ASSERT_TRUE(writer.write(payload));
  EXPECT_TRUE(testing::soon([&] { return memory.use_count() == 1; }));
}

/// Whether a packet from an address of this machine passes the filter for others.
bool passes(const std::vector<LocalAddress>& accepted, std::uint32_t source, std::uint32_t domain) {
  const int socket_at = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(source);
  address.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * domain + 200));
  const auto* at = reinterpret_cast<const sockaddr*>(&address);
  EXPECT_EQ(bind(socket_at, at, sizeof address), 0);
  EXPECT_TRUE(accept_only(accepted, domain));
  EXPECT_EQ(sendto(socket_at, "x", 1, 0, at, sizeof address), 1);
  char byte = 0;
  const bool has_passed = recv(socket_at, &byte, 1, MSG_DONTWAIT) == 1;
  close(socket_at);
  return has_passed;
}

TEST(DdsTopics, AcceptsPacketsOfGivenAddressesOnly) {
  const testing::FreeDomain domain;
  EXPECT_TRUE(passes({}, INADDR_LOOPBACK, domain.id()));
  for (const LocalAddress& local : local_addresses()) {
    EXPECT_TRUE(passes(local_addresses(), local.address, domain.id()));
    EXPECT_EQ(passes({}, local.address, domain.id()), local.is_loopback);
  }
}

TEST(DdsTopics, OtherMachinesDoNotReachItsSockets) {
  const Participants two;
  EXPECT_GE(domain_sockets(two.domain.id()).size(), 3U);
  for (const int descriptor : domain_sockets(two.domain.id())) {
    socklen_t instructions = 0;  // SO_GET_FILTER: how many the filter has
    ASSERT_EQ(getsockopt(descriptor, SOL_SOCKET, SO_GET_FILTER, nullptr, &instructions), 0);
    EXPECT_GT(instructions, 4U);
  }
}

TEST(DdsMessageSink, ReportsTopicsThatOtherProgramsPublishToo) {
  std::vector<std::string> said;
  link::ErrorLog errors(
      {.log = [&](Severity, std::string_view text) { said.emplace_back(text); }, .progress = {}});
  const testing::FreeDomain domain;
  const Participant ours({.id = domain.id()}, errors);
  link::ErrorLog unused({});
  const Participant others({.id = domain.id()}, unused);
  const TopicWriter transforms = writer_of<ros::TFMessage>(others, "/tf");
  MessageSink sink(ours, {});
  for (const char* name : {"/tf", "/clock", "/points"}) {
    sink.add_topic(std::string_view(name) == "/tf" ? ros::make_topic<ros::TFMessage>(name)
                                                   : ros::make_topic<ros::Clock>(name));
  }
  const auto has_said = [&](const char* what) {
    sink.report_other_publishers();
    return std::ranges::any_of(
        said, [&](const std::string& text) { return text.find(what) != std::string::npos; });
  };
  EXPECT_FALSE(has_said("another program"));
  const TopicWriter clock = writer_of<ros::Clock>(others, "/clock");
  EXPECT_TRUE(testing::soon([&] { return has_said("another program also publishes /clock, so"); }));
  EXPECT_FALSE(has_said("/tf"));
}

}  // namespace
}  // namespace glidar::dds
