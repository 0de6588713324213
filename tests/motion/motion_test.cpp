// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/motion.hpp>

#include <gtest/gtest.h>

namespace glidar {
namespace {

TEST(StandingStill, PutsEverythingWhereTheSceneHasIt) {
  Scene scene;
  scene.instances.push_back({.name = "a", .materials = {}});
  scene.instances[0].world_from_object.translation() = Eigen::Vector3d(1.0, 2.0, 3.0);
  Pose sensor = Pose::Identity();
  sensor.translation() = Eigen::Vector3d(0.0, 0.0, 9.0);
  Frame frame;
  frame.stamp_ns = 123;
  place(standing_still(scene, sensor), frame);
  EXPECT_TRUE(frame.world_from_sensor.isApprox(sensor));
  ASSERT_EQ(frame.world_from_instance.size(), 1U);
  EXPECT_TRUE(frame.world_from_instance[0].isApprox(scene.instances[0].world_from_object));
}

}  // namespace
}  // namespace glidar
