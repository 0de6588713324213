// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/link/dds/pose_decoder.hpp>
#include "pose_messages.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <string>

namespace glidar::dds {
namespace {

FramedPose edge(const std::string& parent, const std::string& child, std::int64_t t_ns,
                const Eigen::Vector3d& position,
                const Eigen::Quaterniond& orientation = Eigen::Quaterniond::Identity()) {
  return {.frames = {parent, child},
          .pose = {.t_ns = t_ns, .position_m = position, .orientation = orientation}};
}

const Eigen::Quaterniond kLeft(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ()));

TEST(TransformTree, ChainsTransforms) {
  TransformTree tree;
  tree.set(edge("map", "odom", 5, {10.0, 0.0, 0.0}, kLeft), false);
  tree.set(edge("odom", "base", 7, {1.0, 0.0, 0.0}), false);
  tree.set(edge("base", "lidar", 99, {0.0, 0.0, 2.0}), true);
  const auto pose = tree.find("map", "lidar");
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->t_ns, 7);  // the newest of those that are not static
  EXPECT_TRUE(pose->position_m.isApprox(Eigen::Vector3d(10.0, 1.0, 2.0)));
  EXPECT_TRUE(pose->orientation.isApprox(kLeft));
}

TEST(TransformTree, FindsPosesAcrossBranchesAndUpwards) {
  TransformTree tree;
  tree.set(edge("map", "a", 1, {1.0, 0.0, 0.0}), false);
  tree.set(edge("map", "b", 2, {0.0, 3.0, 0.0}, kLeft), false);
  const auto across = tree.find("b", "a");
  ASSERT_TRUE(across);
  EXPECT_TRUE(across->position_m.isApprox(Eigen::Vector3d(-3.0, -1.0, 0.0)));
  EXPECT_EQ(across->t_ns, 2);
  const auto up = tree.find("a", "map");
  ASSERT_TRUE(up);
  EXPECT_TRUE(up->position_m.isApprox(Eigen::Vector3d(-1.0, 0.0, 0.0)));
}

TEST(TransformTree, UsesTheNewestTransform) {
  TransformTree tree;
  tree.set(edge("map", "base", 1, {1.0, 0.0, 0.0}), false);
  tree.set(edge("odom", "base", 2, {2.0, 0.0, 0.0}), false);
  EXPECT_FALSE(tree.find("map", "base"));  // a frame has one parent
  EXPECT_DOUBLE_EQ(tree.find("odom", "base")->position_m.x(), 2.0);
}

TEST(TransformTree, FindsNothingBetweenUnconnectedFrames) {
  TransformTree tree;
  tree.set(edge("map", "base", 1, Eigen::Vector3d::Zero()), false);
  EXPECT_FALSE(tree.find("map", "other"));
  EXPECT_FALSE(tree.find("other", "base"));
}

TEST(TransformTree, SurvivesLoops) {
  TransformTree tree;
  EXPECT_FALSE(tree.set(edge("a", "a", 1, Eigen::Vector3d::Zero()), false));
  tree.set(edge("a", "b", 1, Eigen::Vector3d::Zero()), false);
  tree.set(edge("b", "a", 1, Eigen::Vector3d::Zero()), false);
  EXPECT_FALSE(tree.find("map", "a"));
}

TEST(TransformTree, LimitsTheNumberOfFrames) {
  TransformTree tree;
  for (std::size_t i = 0; i < TransformTree::kMaxFrames; ++i)
    ASSERT_TRUE(tree.set(edge("map", std::to_string(i), 1, Eigen::Vector3d::Zero()), false));
  EXPECT_FALSE(tree.set(edge("map", "one more", 1, Eigen::Vector3d::Zero()), false));
  EXPECT_TRUE(tree.set(edge("map", "0", 2, {5.0, 0.0, 0.0}), false));
}

}  // namespace

namespace {

using testing::cdr;
using testing::odometry;
using testing::transform;

const ros::MessageType& kOdometry = ros::message_type<ros::Odometry>();
const ros::MessageType& kTransforms = ros::message_type<ros::TFMessage>();

TEST(PoseDecoder, DecodesOdometry) {
  const std::vector<FramedPose> poses = decode_poses(kOdometry, cdr(odometry(5, {1.0, 2.0, 3.0})));
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_EQ(poses[0].frames, (ros::FramePair{"odom", "base_link"}));
  EXPECT_EQ(poses[0].pose.t_ns, 5'000'000'000);
  EXPECT_EQ(poses[0].pose.position_m, Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(PoseDecoder, DecodesPosesWithoutAChild) {
  ros::PoseStamped message;
  message.header.frame_id = "/map";
  message.pose.orientation = {0.0, 0.6, 0.0, 0.8};
  const auto poses = decode_poses(ros::message_type<ros::PoseStamped>(), cdr(message));
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_EQ(poses[0].frames, (ros::FramePair{"map", ""}));
  EXPECT_DOUBLE_EQ(poses[0].pose.orientation.y(), 0.6);
}

TEST(PoseDecoder, DecodesAllTransforms) {
  const ros::TFMessage message{{transform("map", "odom", 1, {}), transform("odom", "base", 2, {})}};
  const std::vector<FramedPose> poses = decode_poses(kTransforms, cdr(message));
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[1].frames, (ros::FramePair{"odom", "base"}));
}

TEST(PoseDecoder, NormalisesRoundedQuaternions) {
  auto message = odometry(1, {});
  message.pose.orientation = {0.0, 0.0, 0.7071, 0.7071};
  const auto poses = decode_poses(kOdometry, cdr(message));
  EXPECT_NEAR(poses.at(0).pose.orientation.norm(), 1.0, 1e-15);
}

TEST(PoseDecoder, RefusesInvalidNumbers) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const ros::Vector3 position :
       {ros::Vector3{kNan, 0.0, 0.0}, ros::Vector3{0.0, kInfinity, 0.0},
        ros::Vector3{0.0, 0.0, 1e300}}) {
    EXPECT_THROW(decode_poses(kOdometry, cdr(odometry(1, position))), Error);
  }
  for (const ros::Quaternion rotation :
       {ros::Quaternion{0.0, 0.0, 0.0, 0.0}, ros::Quaternion{0.0, 0.0, 0.0, 2.0},
        ros::Quaternion{kNan, 0.0, 0.0, 1.0}, ros::Quaternion{0.0, 0.0, 0.0, kInfinity}}) {
    auto message = odometry(1, {});
    message.pose.orientation = rotation;
    EXPECT_THROW(decode_poses(kOdometry, cdr(message)), Error);
  }
  auto message = odometry(1, {});
  message.header.stamp.nanosec = 1'000'000'000;
  EXPECT_THROW(decode_poses(kOdometry, cdr(message)), Error);
}

TEST(PoseDecoder, RefusesNamesThatAreEmptyOrTooLong) {
  for (const std::string& name :
       {std::string(), std::string("/"), std::string(kMaxFrameName_bytes + 1, 'a'),
        std::string("a\0b", 3)}) {
    auto message = odometry(1, {});
    message.child_frame_id = name;
    EXPECT_THROW(decode_poses(kOdometry, cdr(message)), Error) << name.size();
    message = odometry(1, {});
    message.header.frame_id = name;
    EXPECT_THROW(decode_poses(kOdometry, cdr(message)), Error) << name.size();
  }
}

TEST(PoseDecoder, RefusesDamagedMessages) {
  const std::vector<std::byte> whole = cdr(odometry(1, {}));
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(decode_poses(kOdometry, std::span(whole).first(size)), Error) << size;
  std::vector<std::byte> huge = cdr(ros::TFMessage{});
  std::fill_n(huge.begin() + 4, 4, std::byte{0xFF});  // 4 thousand million transforms
  EXPECT_THROW(decode_poses(kTransforms, huge), Error);
}

TEST(PoseDecoder, RefusesTooManyTransforms) {
  const ros::TFMessage message{
      std::vector<ros::TransformStamped>(kMaxTransforms + 1, transform("a", "b", 1, {}))};
  EXPECT_THROW(decode_poses(kTransforms, cdr(message)), Error);
}

TEST(PoseDecoder, DecodesTheClock) {
  EXPECT_EQ(decode_clock(cdr(ros::Clock{{3, 4}})), 3'000'000'004);
  EXPECT_THROW(decode_clock(cdr(ros::Clock{{3, 1'000'000'000}})), Error);
  EXPECT_THROW(decode_clock(cdr(odometry(1, {}))), Error);
}

}  // namespace
}  // namespace glidar::dds
