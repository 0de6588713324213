// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/rig_messages.hpp>
#include <glidar/io/config/imu_file.hpp>

#include "io/ros/memory_sink.hpp"
#include "live_scene.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace glidar::app {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Key;
using ::testing::Not;

void publish(ros::RigPublisher& publisher, LiveScene& scene) {
  for (const std::uint32_t number : {0U, 1U}) {
    const MeasuredFrame measured = scene.measure(number);
    publisher.publish(0, measured.frame, *measured.beams);
  }
  publisher.finish();
}

struct ImuScene : LiveScene {
  ImuScene() {
    Imu imu;
    imu.rate_hz = 100.0;
    prepared.imus = {{.name = "imu", .imu = imu}};
  }
};

TEST(RigMessages, AreWrittenInTheOrderOfTime) {
  ImuScene scene;
  ros::MemorySink sink;
  publish(*make_rig_publisher(sink, scene.flags, scene.prepared, PoseOrigin::motion), scene);
  const auto is_earlier = [](const auto& a, const auto& b) { return a.time_ns < b.time_ns; };
  EXPECT_TRUE(std::is_sorted(sink.messages.begin(), sink.messages.end(), is_earlier));
  EXPECT_EQ(sink.counts().at("/imu/data"), 21U);  // both ends of 0.2 s
  EXPECT_EQ(sink.messages.back().time_ns, 200'000'000);
}

TEST(RigMessages, HaveThePoseAtTheTimeOfEveryCloudBeforeIt) {
  LiveScene scene;
  ros::MemorySink sink;
  publish(*make_rig_publisher(sink, scene.flags, scene.prepared, PoseOrigin::motion), scene);
  std::int64_t pose_ns = -1;
  std::size_t clouds = 0;
  for (const auto& written : sink.messages) {
    if (written.topic == "/tf") pose_ns = written.time_ns;
    if (written.topic != "/lidar/points") continue;
    EXPECT_EQ(written.time_ns, pose_ns);
    ++clouds;
  }
  EXPECT_EQ(clouds, 2U);
}

TEST(RigMessages, HaveThePosesOfFramesWhenTheMotionIsNotKnown) {
  ImuScene scene;
  ros::MemorySink sink;
  publish(*make_rig_publisher(sink, scene.flags, scene.prepared, PoseOrigin::frames), scene);
  EXPECT_THAT(sink.counts(), Not(Contains(Key("/imu/data"))));
  const auto poses = sink.of<ros::Odometry>("/odom");
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(ros::to_ns(poses[1].header.stamp), 100'000'000);
  EXPECT_EQ(poses[0].angular_velocity.z, 0.0);
  EXPECT_NEAR(poses[1].angular_velocity.z, 0.5, 1e-9);  // the mean since the last frame
  EXPECT_NEAR(poses[1].pose.position.x, 0.5, 1e-12);
}

TEST(RigMessages, BeginAtTheFirstFrameAndAgainAfterALongGap) {
  ImuScene scene;
  ros::MemorySink sink;
  const auto publisher = make_rig_publisher(sink, scene.flags, scene.prepared, PoseOrigin::motion);
  constexpr std::int64_t kDay_ns = 86'400'000'000'000;
  for (const std::int64_t start_ns : {kDay_ns, 2 * kDay_ns}) {
    MeasuredFrame measured = scene.measure(0);
    measured.frame.stamp_ns = start_ns;
    publisher->publish(0, measured.frame, *measured.beams);
  }
  publisher->finish();
  EXPECT_EQ(sink.counts().at("/imu/data"),
            12U);  // one at the first frame, eleven from the second on
  EXPECT_LE(sink.counts().at("/odom"), 15U);
}

TEST(RigMessages, OfViewersHaveTrueRangesAndImages) {
  LiveScene scene;
  ros::MemorySink sink;
  publish(*make_rig_publisher(sink, scene.flags, scene.prepared, PoseOrigin::motion, true), scene);
  const auto images = sink.of<ros::Image>("/lidar/range/image_raw");
  ASSERT_EQ(images.size(), 2U);
  EXPECT_EQ(images[0].height, 16U);
  EXPECT_EQ(sink.counts().at("/lidar/intensity/image_raw"), 2U);
  std::vector<std::string> names;
  const auto clouds = sink.of<ros::PointCloud2>("/lidar/points");
  for (const auto& field : clouds.at(0).fields) names.push_back(field.name);
  EXPECT_THAT(names, ElementsAre("x", "y", "z", "intensity", "ring", "time", "range", "true_range",
                                 "instance", "class"));
}

TEST(RigMessages, AreMadeOnlyForTopicsThatAreWanted) {
  LiveScene scene;
  ros::MemorySink sink;
  sink.wanted = [](const std::string& topic) { return topic.ends_with("range/image_raw"); };
  publish(*make_rig_publisher(sink, scene.flags, scene.prepared, PoseOrigin::motion, true), scene);
  EXPECT_EQ(sink.counts().at("/lidar/range/image_raw"), 2U);
  EXPECT_THAT(sink.counts(), Not(Contains(Key("/lidar/points"))));
}

}  // namespace
}  // namespace glidar::app
