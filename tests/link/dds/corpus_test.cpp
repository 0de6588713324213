// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The fuzzer's corpus of poses from ROS 2, in every build.
#include "support/corpus.hpp"
#include "fuzz/ros_poses_decoders.hpp"

#include <gmock/gmock.h>

namespace glidar::dds {
namespace {

TEST(RosPoseCorpus, AcceptsValidMessagesOnly) {
  const auto [accepted, files] =
      testing::decode_corpus("ros_poses", testing::try_ros_poses_decoders);
  EXPECT_EQ(files, 8U);
  EXPECT_THAT(accepted, ::testing::ElementsAre("clock", "loop", "odometry", "pose", "transforms"));
}

}  // namespace
}  // namespace glidar::dds
