// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/participant.hpp>

#include "participants.hpp"

#include <gmock/gmock.h>

#include <cstddef>
#include <optional>

namespace glidar::dds {
namespace {

using testing::is_matched;
using testing::odometry;
using testing::Participants;
using testing::payload_of;
using testing::transform;
using testing::writer_of;

std::optional<TimedPose> next(PoseSubscriber& subscriber) {
  return testing::wait_for(subscriber.descriptor(), [&] { return subscriber.receive(); });
}

/// Receives until the subscriber has found the publisher, which must not have written yet.
bool finds(PoseSubscriber& subscriber, const TopicWriter& writer) {
  return testing::soon([&] { return !subscriber.receive() && writer.has_readers(); });
}

TEST(PoseSubscriber, ReceivesOdometry) {
  const Participants two;
  PoseSubscriber subscriber(two.ours, parse_pose_topic("/odom"), 10);
  TopicWriter writer = writer_of<ros::Odometry>(two.others, "/odom");
  ASSERT_TRUE(finds(subscriber, writer));
  writer.write(payload_of(odometry(3, {1.0, 2.0, 3.0})));
  writer.write(payload_of(odometry(4, {2.0, 2.0, 3.0})));
  const auto first = next(subscriber);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->t_ns, 3'000'000'000);
  EXPECT_EQ(first->position_m, Eigen::Vector3d(1.0, 2.0, 3.0));
  const auto second = next(subscriber);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->t_ns, 4'000'000'000);
}

TEST(PoseSubscriber, ReceivesPosesOfBestEffortPublishers) {
  const Participants two;
  PoseSubscriber subscriber(two.ours, parse_pose_topic("pose", "robot"), 10);
  TopicWriter writer(two.others, "/robot/pose", ros::message_type<ros::PoseStamped>(),
                     {.reliable = false, .depth = 5});
  ASSERT_TRUE(finds(subscriber, writer));
  ros::PoseStamped message;
  message.header.stamp.sec = 9;
  message.header.frame_id = "map";
  writer.write(payload_of(message));
  const auto pose = next(subscriber);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->t_ns, 9'000'000'000);
}

TEST(PoseSubscriber, ReceivesAFrameOfTransforms) {
  const Participants two;
  const ros::MessageType& type = ros::message_type<ros::TFMessage>();
  TopicWriter fixed(two.others, "/tf_static", type, ros::kStaticTransformQos);
  fixed.write(payload_of(ros::TFMessage{{transform("base", "lidar", 1, {0.0, 0.0, 2.0})}}));
  TopicWriter moving = writer_of<ros::TFMessage>(two.others, "/tf");
  PoseSubscriber subscriber(two.ours, parse_pose_topic("/tf:map:lidar"), 10);
  // the static transform arrives at some time, so the other one is repeated
  std::int32_t sec = 1;
  ASSERT_TRUE(is_matched(moving));
  std::optional<TimedPose> pose;
  ASSERT_TRUE(testing::soon([&] {
    moving.write(payload_of(ros::TFMessage{{transform("map", "base", sec++, {5.0, 0.0, 0.0})}}));
    pose = subscriber.receive();
    return pose.has_value();
  }));
  EXPECT_TRUE(pose->position_m.isApprox(Eigen::Vector3d(5.0, 0.0, 2.0)));
  EXPECT_GT(pose->t_ns, 0);
}

TEST(PoseSubscriber, ReportsATypeWithoutPoses) {
  const Participants two;
  PoseSubscriber subscriber(two.ours, parse_pose_topic("/imu"), 10);
  const TopicWriter writer = writer_of<ros::Imu>(two.others, "/imu");
  EXPECT_TRUE(testing::soon([&] {
    EXPECT_FALSE(subscriber.receive());
    return two.has_reported("ROS topic /imu");
  }));
}

TEST(PoseSubscriber, ContinuesAfterInvalidMessages) {
  const Participants two;
  PoseSubscriber subscriber(two.ours, parse_pose_topic("/odom"), 10);
  TopicWriter writer = writer_of<ros::Odometry>(two.others, "/odom");
  ASSERT_TRUE(finds(subscriber, writer));
  auto invalid = odometry(1, {});
  invalid.pose.orientation = {0.0, 0.0, 0.0, 0.0};
  writer.write(payload_of(invalid));
  link::Payload damaged = payload_of(odometry(2, {}));
  damaged.size = 20;
  writer.write(damaged);
  writer.write(payload_of(odometry(3, {})));
  const auto pose = next(subscriber);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->t_ns, 3'000'000'000);
  EXPECT_EQ(subscriber.counts().invalid, 2U);
  EXPECT_EQ(subscriber.counts().received, 3U);
}

TEST(PoseSubscriber, KeepsTheNewestPosesOnly) {
  const Participants two;
  PoseSubscriber subscriber(two.ours, parse_pose_topic("/odom"), 0);
  TopicWriter writer = writer_of<ros::Odometry>(two.others, "/odom");
  ASSERT_TRUE(finds(subscriber, writer));
  for (std::int32_t sec = 1; sec <= 9; ++sec) writer.write(payload_of(odometry(sec, {})));
  ASSERT_TRUE(writer.wait_for_acknowledgements(testing::kMaxWait));
  std::optional<TimedPose> last;
  ASSERT_TRUE(testing::soon([&] {
    if (const auto pose = subscriber.receive()) last = pose;
    return last && last->t_ns == 9'000'000'000;
  }));
  EXPECT_FALSE(subscriber.receive());
}

TEST(ClockSubscriber, ReceivesTheNewestTime) {
  const Participants two;
  ClockSubscriber subscriber(two.ours);
  TopicWriter writer = writer_of<ros::Clock>(two.others, "/clock");
  ASSERT_TRUE(is_matched(writer));
  writer.write(payload_of(ros::Clock{{1, 0}}));
  writer.write(payload_of(ros::Clock{{2, 5}}));
  std::optional<std::int64_t> last;
  ASSERT_TRUE(testing::soon([&] {
    if (const auto time = subscriber.receive()) last = time;
    return last == 2'000'000'005;
  }));
  writer.write(payload_of(ros::Clock{{3, 2'000'000'000}}));
  EXPECT_TRUE(testing::soon([&] {
    EXPECT_FALSE(subscriber.receive());
    return subscriber.counts().invalid == 1U;
  }));
}

}  // namespace
}  // namespace glidar::dds
