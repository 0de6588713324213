// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/pose_topic.hpp>

#include <glidar/core/error.hpp>

#include <gtest/gtest.h>

namespace glidar::dds {
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
