// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/core/output_frame.hpp>
#include <support/error_text.hpp>

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

/// A point 3 m ahead, 2 m to the left and 1 m up, in the coordinate frame of this name.
Eigen::Vector3d seen(const std::string& name, const Beams& beams) {
  const Eigen::Vector3d in_sensor =
      looks_along_z(beams) ? Eigen::Vector3d(-2.0, -1.0, 3.0) : Eigen::Vector3d(3.0, 2.0, 1.0);
  return output_frame(name, beams, Pose::Identity()).cloud_from_sensor * in_sensor;
}

TEST(OutputFrame, HasTheNamedAxesForEverySensor) {
  for (const Beams& beams : {camera(), lidar()}) {
    EXPECT_EQ(seen("optical", beams), Eigen::Vector3d(-2.0, -1.0, 3.0));
    EXPECT_EQ(seen("ros", beams), Eigen::Vector3d(3.0, 2.0, 1.0));
    EXPECT_EQ(seen("gl", beams), Eigen::Vector3d(-2.0, 1.0, -3.0));
    EXPECT_EQ(seen("legacy", beams), Eigen::Vector3d(2.0, 1.0, 3.0));
  }
}

TEST(OutputFrame, SensorFrameIsIdentityAndWorldFrameIsTheSensorPose) {
  const Pose pose = make_pose({1.0, 2.0, 3.0}, Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5));
  const OutputFrame own = output_frame("sensor", lidar(), pose);
  EXPECT_EQ(own.frame_id, "lidar_frame");
  EXPECT_EQ(own.cloud_from_sensor.matrix(), Pose::Identity().matrix());
  const OutputFrame world = output_frame("world", lidar(), pose);
  EXPECT_EQ(world.frame_id, "world");
  EXPECT_EQ(world.cloud_from_sensor.matrix(), pose.matrix());
}

TEST(OutputFrame, EveryNameIsKnown) {
  for (const std::string& name : output_frame_names())
    EXPECT_TRUE(is_rigid(output_frame(name, camera(), Pose::Identity()).cloud_from_sensor)) << name;
}

TEST(OutputFrame, UnknownNameIsAnErrorWithTheClosestMatch) {
  EXPECT_EQ(error_text([&] { output_frame("optcal", camera(), Pose::Identity()); }),
            "coordinate frame: 'optcal'; allowed: sensor, optical, ros, gl, world, legacy; "
            "did you mean optical?");
}

}  // namespace
}  // namespace glidar
