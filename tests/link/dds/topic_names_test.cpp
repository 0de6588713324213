// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/link/dds/topic_names.hpp>

#include <gtest/gtest.h>

namespace glidar::dds {
namespace {

TEST(TopicNames, RelativeNamesAreInTheNamespace) {
  EXPECT_EQ(full_topic_name("velodyne_points"), "/velodyne_points");
  EXPECT_EQ(full_topic_name("points", "robot"), "/robot/points");
  EXPECT_EQ(full_topic_name("points", "/fleet/robot"), "/fleet/robot/points");
  EXPECT_EQ(full_topic_name("points", "/robot/"), "/robot/points");
  EXPECT_EQ(full_topic_name("/tf", "robot"), "/tf");
}

TEST(TopicNames, HaveThePrefixOfRosInDds) {
  EXPECT_EQ(dds_topic_name("/robot/points"), "rt/robot/points");
}

TEST(TopicNames, RefusesNamesThatRosRefuses) {
  for (const char* name : {"", "/", "points/", "a//b", "1st", "/a/2nd", "a-b", "a b", "~/points",
                           "a__b", "caf\u00e9", "/a\n"}) {
    EXPECT_THROW(full_topic_name(name), Error) << name;
  }
  EXPECT_THROW(full_topic_name("points", "my robot"), Error);
  EXPECT_NO_THROW(full_topic_name("/" + std::string(246, 'a')));
  EXPECT_THROW(full_topic_name("/" + std::string(247, 'a')), Error);
}

}  // namespace

namespace {

TEST(PoseTopic, IsATopicOrTwoFramesOfTransforms) {
  const PoseTopic odometry = parse_pose_topic("/odom");
  EXPECT_EQ(odometry.name, "/odom");
  EXPECT_FALSE(has_frames(odometry));
  const PoseTopic transforms = parse_pose_topic("/tf:map:base_link");
  EXPECT_EQ(transforms.name, "/tf");
  EXPECT_EQ(transforms.parent_frame, "map");
  EXPECT_EQ(transforms.child_frame, "base_link");
  EXPECT_EQ(parse_pose_topic("odom", "robot").name, "/robot/odom");
}

TEST(PoseTopic, RefusesIncompleteFrames) {
  for (const char* text :
       {"", "odom:", "/tf:map", "/tf:map:", "/tf::base", "/tf:map:map", "/tf:a:b:c", "/t f:a:b"}) {
    EXPECT_THROW(parse_pose_topic(text), Error) << text;
  }
}

}  // namespace
}  // namespace glidar::dds
