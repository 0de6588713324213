// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/imu_file.hpp>

#include "io/ros/memory_sink.hpp"
#include "live_scene.hpp"

#include <gmock/gmock.h>

#include <glidar/io/ros/pose_message.hpp>

#include <algorithm>
#include <cmath>
#include <set>

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
  publish(*scene.publisher(sink), scene);
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
  const auto publisher = scene.publisher(sink);
  publisher->advance(50'000'000);
  EXPECT_THAT(sink.counts(), Not(Contains(Key("/clock"))));  // not before the first frame
  const MeasuredFrame first = scene.measure(0);
  publisher->publish(0, first.frame, *first.beams);
  publisher->advance(55'000'000);
  EXPECT_EQ(sink.counts().at("/imu/data"), 11U);  // the frame is delivered at its end
  EXPECT_EQ(sink.messages.back().time_ns, 100'000'000);
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
  publish(*scene.publisher(sink), scene);
  const auto poses = sink.of<ros::Odometry>("/ground_truth/odom");
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

std::set<std::int64_t> transform_stamps(const ros::MemorySink& sink) {
  std::set<std::int64_t> stamps;
  for (const ros::TFMessage& message : sink.of<ros::TFMessage>("/tf"))
    stamps.insert(ros::to_ns(message.transforms.at(0).header.stamp));
  return stamps;
}

TEST(RigMessages, HaveATransformWithTheStampOfEveryCloud) {
  for (const bool is_live : {false, true}) {
    LiveScene scene;
    ros::MemorySink sink;
    const auto publisher = scene.publisher(sink);
    for (const std::uint32_t number : {0U, 1U}) {
      const MeasuredFrame measured = scene.measure(number);
      publisher->publish(0, measured.frame, *measured.beams);
      if (is_live) publisher->advance(measured.frame.stamp_ns + 190'000'001);
    }
    publisher->finish();
    const std::set<std::int64_t> stamps = transform_stamps(sink);
    const auto clouds = sink.of<ros::PointCloud2>("/lidar/points");
    ASSERT_EQ(clouds.size(), 2U);
    for (const auto& cloud : clouds) EXPECT_TRUE(stamps.contains(ros::to_ns(cloud.header.stamp)));
    EXPECT_EQ(stamps.size(), sink.counts().at("/tf"));  // none is repeated
  }
}

TEST(RigMessages, OfScansAreWrittenAfterTheirLastPoint) {
  LiveScene scene;
  ros::MemorySink sink;
  publish(*scene.publisher(sink), scene);
  std::vector<std::int64_t> times;
  for (const auto& written : sink.messages)
    if (written.topic == "/lidar/points") times.push_back(written.time_ns);
  EXPECT_THAT(times, ElementsAre(100'000'000, 200'000'000));
}

TEST(RigMessages, OfTheClockNeverStepBack) {
  LiveScene scene;
  ros::MemorySink sink;
  const auto publisher = scene.publisher(sink);
  for (const std::uint32_t number : {0U, 1U}) {
    const MeasuredFrame measured = scene.measure(number);
    publisher->publish(0, measured.frame, *measured.beams);
    publisher->advance(measured.frame.stamp_ns + 155'000'000);
  }
  publisher->finish();
  std::int64_t last_ns = -1;
  for (const ros::Clock& clock : sink.of<ros::Clock>("/clock")) {
    EXPECT_GT(ros::to_ns(clock.clock), last_ns);
    last_ns = ros::to_ns(clock.clock);
  }
}

/// The transforms of /tf, as parent > child.
std::set<std::string> frame_pairs(const ros::MemorySink& sink, const std::string& topic) {
  std::set<std::string> pairs;
  for (const ros::TFMessage& message : sink.of<ros::TFMessage>(topic))
    for (const ros::TransformStamped& one : message.transforms)
      pairs.insert(one.header.frame_id.bytes() + " > " + one.child_frame_id.bytes());
  return pairs;
}

TEST(RigMessages, OfTheGroundTruthLeaveTheParentOfTheBodyToOthers) {
  LiveScene scene;
  ros::MemorySink sink;
  publish(*scene.publisher(sink), scene);
  EXPECT_THAT(frame_pairs(sink, "/tf"), ElementsAre("base_link > ground_truth"));
  EXPECT_THAT(frame_pairs(sink, "/tf_static"), ElementsAre("base_link > lidar_frame"));
  EXPECT_THAT(sink.counts(), Not(Contains(Key("/odom"))));
  const auto odometry = sink.of<ros::Odometry>("/ground_truth/odom");
  const auto transforms = sink.of<ros::TFMessage>("/tf");
  ASSERT_EQ(odometry.size(), transforms.size());
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    EXPECT_EQ(odometry[i].header.frame_id, "ground_truth");
    EXPECT_EQ(odometry[i].child_frame_id, "base_link");
    const TimedPose there = ros::timed_pose(odometry[i]);
    const TimedPose back = ros::timed_pose(transforms[i].transforms.at(0));
    const Eigen::Vector3d nothing = there.position_m + there.orientation * back.position_m;
    EXPECT_NEAR(nothing.norm(), 0.0, 1e-12);
    EXPECT_NEAR(std::abs((there.orientation * back.orientation).w()), 1.0, 1e-12);
  }
}

TEST(RigMessages, HaveThePosesOfTheRequestedFrames) {
  for (const auto mode :
       {ros::TransformMode::odom, ros::TransformMode::map, ros::TransformMode::none}) {
    LiveScene scene;
    scene.flags.output.messages.tf = mode;
    scene.flags.output.messages.frame_prefix = "robot1/";
    ros::MemorySink sink;
    publish(*scene.publisher(sink), scene);
    const auto odometry = sink.of<ros::Odometry>("/odom");
    EXPECT_GT(sink.counts().at("/clock"), 20U);
    if (mode == ros::TransformMode::none) {
      EXPECT_THAT(sink.counts(), Not(Contains(Key("/tf"))));
      EXPECT_THAT(sink.counts(), Not(Contains(Key("/tf_static"))));
      EXPECT_TRUE(odometry.empty());
      continue;
    }
    const bool is_map = mode == ros::TransformMode::map;
    EXPECT_THAT(frame_pairs(sink, "/tf"),
                ElementsAre(is_map ? "map > robot1/base_link" : "robot1/odom > robot1/base_link"));
    EXPECT_THAT(frame_pairs(sink, "/tf_static"),
                ElementsAre("robot1/base_link > robot1/lidar_frame"));
    const TimedPose first = ros::timed_pose(odometry.at(0));
    EXPECT_NEAR(first.position_m.x(), is_map ? 0.5 : 0.0, 1e-12);
    EXPECT_NEAR(odometry.at(0).angular_velocity.z, 0.5, 1e-12);
    EXPECT_EQ(sink.of<ros::PointCloud2>("/lidar/points").at(0).header.frame_id,
              "robot1/lidar_frame");
  }
}

TEST(RigMessages, OfImusHaveCovariancesAndAnOrientationOnRequest) {
  for (const bool has_orientation : {false, true}) {
    ImuScene scene;
    glidar::Imu& imu = scene.prepared.imus.front().imu;
    imu.gyroscope.noise_density = 0.001;
    imu.accelerometer.noise_density = 0.02;
    scene.flags.output.messages.imu_orientation = has_orientation;
    ros::MemorySink sink;
    publish(*scene.publisher(sink), scene);
    const ros::Imu message = sink.of<ros::Imu>("/imu/data").at(10);  // after 0.1 s of 0.5 rad/s
    EXPECT_NEAR(message.angular_velocity_covariance[4], 1e-6 * 100.0, 1e-15);
    EXPECT_NEAR(message.linear_acceleration_covariance[8], 4e-4 * 100.0, 1e-15);
    EXPECT_EQ(message.linear_acceleration_covariance[1], 0.0);
    EXPECT_EQ(message.orientation_covariance[0] > 0.0, has_orientation);
    EXPECT_EQ(message.orientation_covariance[0] == -1.0, !has_orientation);
    EXPECT_NEAR(message.orientation.z, has_orientation ? std::sin(0.025) : 0.0, 1e-9);
  }
}

TEST(RigMessages, OfACameraWithoutARigHaveABodyWithXForward) {
  LiveScene scene("D435");
  ros::MemorySink sink;
  publish(*scene.publisher(sink), scene);
  EXPECT_THAT(frame_pairs(sink, "/tf_static"),
              ElementsAre("base_link > camera_link", "camera_link > camera_depth_optical_frame"));
  const ros::TFMessage fixed = sink.of<ros::TFMessage>("/tf_static").at(0);
  EXPECT_EQ(ros::timed_pose(fixed.transforms.at(0)).position_m.norm(), 0.0);
  EXPECT_NEAR(std::abs(fixed.transforms.at(0).transform.rotation.w), 1.0, 1e-12);
  const ros::Quaternion turned = fixed.transforms.at(1).transform.rotation;
  EXPECT_NEAR(turned.x, -0.5, 1e-12);
  EXPECT_NEAR(turned.y, 0.5, 1e-12);
  EXPECT_NEAR(turned.z, -0.5, 1e-12);
  EXPECT_NEAR(turned.w, 0.5, 1e-12);
  // the boresight of the camera is x of base_link
  const ros::Odometry odometry = sink.of<ros::Odometry>("/ground_truth/odom").at(0);
  const Eigen::Vector3d ahead = ros::timed_pose(odometry).orientation * Eigen::Vector3d::UnitX();
  const Pose camera = scene.measure(0).frame.world_from_sensor;
  EXPECT_NEAR((ahead - camera.linear().col(2)).norm(), 0.0, 1e-12);
  EXPECT_EQ(sink.of<ros::Image>("/camera/depth/image_raw").at(0).header.frame_id,
            "camera_depth_optical_frame");
  EXPECT_EQ(sink.of<ros::Image>("/camera/color/image_raw").at(0).encoding, "rgb8");
  EXPECT_EQ(sink.of<ros::Image>("/camera/intensity/image_raw").at(0).encoding, "mono8");
}

TEST(RigMessages, HaveThePosesOfFramesWhenTheMotionIsNotKnown) {
  ImuScene scene;
  ros::MemorySink sink;
  publish(*scene.publisher(sink, PoseOrigin::frames), scene);
  EXPECT_THAT(sink.counts(), Not(Contains(Key("/imu/data"))));
  const auto poses = sink.of<ros::Odometry>("/ground_truth/odom");
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
  const auto publisher = scene.publisher(sink);
  constexpr std::int64_t kDay_ns = 86'400'000'000'000;
  for (const std::int64_t start_ns : {kDay_ns, 2 * kDay_ns}) {
    MeasuredFrame measured = scene.measure(0);
    measured.frame.stamp_ns = start_ns;
    publisher->publish(0, measured.frame, *measured.beams);
  }
  publisher->finish();
  EXPECT_EQ(sink.counts().at("/imu/data"), 22U);  // eleven of each frame
  EXPECT_LE(sink.counts().at("/ground_truth/odom"), 24U);
}

TEST(RigMessages, StartWithTheRunAlsoWhereItsTimesAreDates) {
  ImuScene scene;
  constexpr std::int64_t kStart_ns = 1'700'000'000'123'456'789;
  scene.prepared.start_ns = kStart_ns;
  ros::MemorySink sink;
  publish(*scene.publisher(sink), scene);
  for (const auto& message : sink.messages) EXPECT_GE(message.time_ns, kStart_ns);
  EXPECT_EQ(sink.messages.front().time_ns, kStart_ns);
  EXPECT_EQ(sink.messages.back().time_ns, kStart_ns + 200'000'000);
  EXPECT_EQ(sink.counts().at("/imu/data"), 21U);
  const auto transforms = sink.of<ros::TFMessage>("/tf_static");
  ASSERT_EQ(transforms.size(), 1U);
  EXPECT_EQ(ros::to_ns(transforms[0].transforms.at(0).header.stamp), kStart_ns);
  const auto poses = sink.of<ros::Odometry>("/ground_truth/odom");
  EXPECT_EQ(ros::to_ns(poses.at(1).header.stamp), kStart_ns + 10'000'000);
}

TEST(RigMessages, OfViewersHaveTrueRangesAndImages) {
  LiveScene scene;
  ros::MemorySink sink;
  publish(*scene.publisher(sink, PoseOrigin::motion, true), scene);
  const auto images = sink.of<ros::Image>("/lidar/range/image_raw");
  ASSERT_EQ(images.size(), 2U);
  EXPECT_EQ(images[0].height, 16U);
  EXPECT_EQ(sink.counts().at("/lidar/intensity/image_raw"), 2U);
  std::vector<std::string> names;
  const auto clouds = sink.of<ros::PointCloud2>("/lidar/points");
  for (const auto& field : clouds.at(0).fields) names.push_back(field.name.bytes());
  EXPECT_THAT(names, ElementsAre("x", "y", "z", "intensity", "ring", "time", "range", "true_range",
                                 "instance", "class"));
}

TEST(RigMessages, AreMadeOnlyForTopicsThatAreWanted) {
  LiveScene scene;
  ros::MemorySink sink;
  sink.wanted = [](const std::string& topic) { return topic.ends_with("range/image_raw"); };
  publish(*scene.publisher(sink, PoseOrigin::motion, true), scene);
  EXPECT_EQ(sink.counts().at("/lidar/range/image_raw"), 2U);
  EXPECT_THAT(sink.counts(), Not(Contains(Key("/lidar/points"))));
}

}  // namespace
}  // namespace glidar::app
