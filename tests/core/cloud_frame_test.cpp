// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/cloud_frame.hpp>
#include <glidar/core/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace glidar {
namespace {

Beams camera() {
  Beams beams;
  beams.frame_id = "camera_optical_frame";
  return beams;
}

Beams lidar() {
  Beams beams;
  beams.frame_id = "lidar_frame";
  beams.boresight = Eigen::Vector3d::UnitX();
  return beams;
}

/// Where a point 3 m ahead, 2 m to the left and 1 m up lies in the frame of this name.
Eigen::Vector3d seen(const std::string& name, const Beams& beams) {
  const Eigen::Vector3d in_sensor =
      looks_along_z(beams) ? Eigen::Vector3d(-2.0, -1.0, 3.0) : Eigen::Vector3d(3.0, 2.0, 1.0);
  return cloud_frame(name, beams, Pose::Identity()).cloud_from_sensor * in_sensor;
}

TEST(CloudFrame, HasTheAxesOfItsNameForEverySensor) {
  for (const Beams& beams : {camera(), lidar()}) {
    EXPECT_EQ(seen("optical", beams), Eigen::Vector3d(-2.0, -1.0, 3.0));
    EXPECT_EQ(seen("ros", beams), Eigen::Vector3d(3.0, 2.0, 1.0));
    EXPECT_EQ(seen("gl", beams), Eigen::Vector3d(-2.0, 1.0, -3.0));
    EXPECT_EQ(seen("legacy", beams), Eigen::Vector3d(2.0, 1.0, 3.0));
  }
}

TEST(CloudFrame, OfTheSensorIsItsOwnAndThatOfTheWorldIsItsPose) {
  const Pose pose = make_pose({1.0, 2.0, 3.0}, Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5));
  const CloudFrame own = cloud_frame("sensor", lidar(), pose);
  EXPECT_EQ(own.frame_id, "lidar_frame");
  EXPECT_EQ(own.cloud_from_sensor.matrix(), Pose::Identity().matrix());
  const CloudFrame world = cloud_frame("world", lidar(), pose);
  EXPECT_EQ(world.frame_id, "world");
  EXPECT_EQ(world.cloud_from_sensor.matrix(), pose.matrix());
}

TEST(CloudFrame, EveryNameIsKnown) {
  for (const std::string& name : cloud_frame_names())
    EXPECT_TRUE(is_rigid(cloud_frame(name, camera(), Pose::Identity()).cloud_from_sensor)) << name;
}

TEST(CloudFrame, UnknownNameIsToldWithTheNearest) {
  try {
    cloud_frame("optcal", camera(), Pose::Identity());
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "coordinate frame: 'optcal'; allowed: sensor, optical, ros, gl, world, legacy; "
                 "did you mean optical?");
  }
}

}  // namespace
}  // namespace glidar
