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

/// Two sensors that begin together, of which the first one fires its first beam later.
struct PairOfSensors {
  static Beams delayed(const Beams& beams) {
    constexpr std::uint32_t kDelay_ns = 50'000;
    Beams result = beams;
    for (std::uint32_t& time : result.times_ns) time += kDelay_ns;
    return result;
  }

  explicit PairOfSensors(ImuScene& scene)
      : scene_of(&scene),
        late_beams(delayed(scene.prepared.sensors.front().beams)),
        rig{.scene = scene.prepared.scene, .sensors = {}} {
    const ActiveSensor& active = scene.prepared.sensors.front();
    rig.sensors.push_back({.name = "late", .sensor = active.sensor, .beams = late_beams});
    rig.sensors.push_back({.name = "early", .sensor = active.sensor, .beams = active.beams});
    rig.world_from_rig = scene.prepared.motion.world_from_rig;
    rig.imus = {{.name = "fast"}, {.name = "slow"}};
    rig.imu_samples = [](std::size_t imu, std::int64_t from_ns, std::int64_t until_ns) {
      const std::int64_t period_ns = imu == 0 ? 3'000'000 : 7'000'000;
      ImuSamples samples;
      for (std::int64_t k = (from_ns + period_ns - 1) / period_ns; k * period_ns < until_ns; ++k) {
        samples.t_ns.push_back(k * period_ns);
        samples.angular_velocity_rad_s.emplace_back(0.0, 0.0, 0.0);
        samples.specific_force_m_s2.emplace_back(0.0, 0.0, 0.0);
      }
      return samples;
    };
  }

  void publish(ros::RigPublisher& publisher) const {
    for (const std::uint32_t number : {0U, 1U}) {
      const MeasuredFrame measured = scene_of->measure(number);
      publisher.publish(0, measured.frame, delayed(*measured.beams));
      publisher.publish(1, measured.frame, *measured.beams);
    }
    publisher.finish();
  }

  ImuScene* scene_of = nullptr;
  Beams late_beams;
  ros::PublishedRig rig;
};

TEST(RigMessages, OfSeveralSensorsAndImusNeverStepBack) {
  ImuScene scene;
  const PairOfSensors pair(scene);
  for (const bool has_motion : {true, false}) {
    ros::MemorySink sink;
    ros::PublishedRig rig = pair.rig;
    if (!has_motion) rig.world_from_rig.reset();
    ros::RigPublisher publisher(sink, rig);
    pair.publish(publisher);
    const auto is_earlier = [](const auto& a, const auto& b) { return a.time_ns < b.time_ns; };
    EXPECT_TRUE(std::is_sorted(sink.messages.begin(), sink.messages.end(), is_earlier));
    EXPECT_EQ(sink.counts().at("/late/points"), 2U);
    EXPECT_EQ(sink.counts().at("/early/points"), 2U);
    const auto clocks = sink.of<ros::Clock>("/clock");
    for (std::size_t i = 1; i < clocks.size(); ++i)
      EXPECT_LT(ros::to_ns(clocks[i - 1].clock), ros::to_ns(clocks[i].clock));
    EXPECT_EQ(has_motion ? sink.counts().at("/fast/data") : 67U, 67U);  // every 3 ms in 0.2 s
  }
}

TEST(RigMessages, BetweenFramesReachTheEndOfTheNextFrameOnly) {
  ImuScene scene;
  ros::MemorySink sink;
  const auto publisher = make_rig_publisher(sink, scene.flags, scene.prepared, PoseOrigin::motion);
  publisher->advance(50'000'000);
  EXPECT_THAT(sink.counts(), Not(Contains(Key("/clock"))));  // not before the first frame
  const MeasuredFrame first = scene.measure(0);
  publisher->publish(0, first.frame, *first.beams);
  publisher->advance(55'000'000);
  EXPECT_EQ(sink.counts().at("/imu/data"), 6U);
  EXPECT_EQ(sink.messages.back().time_ns, 50'000'000);
  publisher->advance(10'000'000'000);
  EXPECT_EQ(sink.messages.back().time_ns, 200'000'000);
  const MeasuredFrame second = scene.measure(1);
  publisher->publish(0, second.frame, *second.beams);
  publisher->finish();
  EXPECT_EQ(sink.counts().at("/imu/data"), 21U);
  EXPECT_EQ(sink.counts().at("/lidar/points"), 2U);
}

TEST(RigMessages, OfOdometryHaveTheVelocitiesOfTheMotionInTheAxesOfTheBody) {
  LiveScene scene;
  ConstantTwist twist;
  twist.pose = make_pose({4.0, 5.0, 6.0}, Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5));
  twist.linear_m_s = {1.0, 2.0, -0.5};
  twist.angular_rad_s = {0.3, -0.2, 0.5};
  scene.prepared.motion.world_from_rig = twist;
  ros::MemorySink sink;
  publish(*make_rig_publisher(sink, scene.flags, scene.prepared, PoseOrigin::motion), scene);
  const auto poses = sink.of<ros::Odometry>("/odom");
  ASSERT_EQ(poses.size(), 22U);  // every 10 ms of 0.2 s, and the start of the second frame
  for (const ros::Odometry& odometry : poses) {
    EXPECT_NEAR(odometry.linear_velocity.x, 1.0, 1e-12);
    EXPECT_NEAR(odometry.linear_velocity.y, 2.0, 1e-12);
    EXPECT_NEAR(odometry.linear_velocity.z, -0.5, 1e-12);
    EXPECT_NEAR(odometry.angular_velocity.x, 0.3, 1e-12);
    EXPECT_NEAR(odometry.angular_velocity.y, -0.2, 1e-12);
    EXPECT_NEAR(odometry.angular_velocity.z, 0.5, 1e-12);
    EXPECT_EQ(odometry.twist_covariance[0], 0.0);
  }
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
  EXPECT_EQ(poses[0].twist_covariance[0], -1.0);  // there is no last frame
  EXPECT_EQ(poses[1].twist_covariance[0], 0.0);
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

TEST(RigMessages, StartWithTheRunAlsoWhereItsTimesAreDates) {
  ImuScene scene;
  constexpr std::int64_t kStart_ns = 1'700'000'000'123'456'789;
  scene.prepared.start_ns = kStart_ns;
  ros::MemorySink sink;
  publish(*make_rig_publisher(sink, scene.flags, scene.prepared, PoseOrigin::motion), scene);
  for (const auto& message : sink.messages) EXPECT_GE(message.time_ns, kStart_ns);
  EXPECT_EQ(sink.messages.front().time_ns, kStart_ns);
  EXPECT_EQ(sink.messages.back().time_ns, kStart_ns + 200'000'000);
  EXPECT_EQ(sink.counts().at("/imu/data"), 21U);
  const auto transforms = sink.of<ros::TFMessage>("/tf_static");
  ASSERT_EQ(transforms.size(), 1U);
  EXPECT_EQ(ros::to_ns(transforms[0].transforms.at(0).header.stamp), kStart_ns);
  const auto poses = sink.of<ros::Odometry>("/odom");
  EXPECT_EQ(ros::to_ns(poses.at(1).header.stamp), kStart_ns + 10'000'000);
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
