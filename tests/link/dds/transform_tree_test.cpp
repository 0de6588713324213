// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/transform_tree.hpp>

#include <gtest/gtest.h>

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
}  // namespace glidar::dds
