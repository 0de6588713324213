// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>

#include <glidar/core/output_frame.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/math/constants.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/error_text.hpp>

#include <limits>

namespace glidar {
namespace {

TEST(LookAt, PutsTheTargetOnTheBoresightAndUpUpwards) {
  const Pose pose = look_at({1.0, 2.0, 3.0}, {1.0, 7.0, 3.0}, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(is_rigid(pose));
  EXPECT_LT(
      (pose.inverse() * Eigen::Vector3d(1.0, 7.0, 3.0) - Eigen::Vector3d(0.0, 0.0, 5.0)).norm(),
      1e-12);
  EXPECT_LT(
      (pose.linear().transpose() * Eigen::Vector3d::UnitZ() + Eigen::Vector3d::UnitY()).norm(),
      1e-12);  // the world's up is the image's -y
}

TEST(LookAt, RejectsUndefinedDirections) {
  const Eigen::Vector3d here = Eigen::Vector3d::Zero();
  EXPECT_THROW(look_at(here, here, Eigen::Vector3d::UnitZ()), Error);
  EXPECT_THROW(look_at(here, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ()), Error);
  EXPECT_THROW(look_at(here, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()), Error);
}

TEST(LookAt, WithoutUpVectorShowsTheWorldsZUpwards) {
  const Pose pose = look_at({1.0, 2.0, 3.0}, {-2.0, 7.0, 3.5});
  EXPECT_TRUE(
      pose.isApprox(look_at({1.0, 2.0, 3.0}, {-2.0, 7.0, 3.5}, Eigen::Vector3d::UnitZ()), 0.0));
}

TEST(LookAt, StraightUpOrDownShowsTheWorldsXUpwards) {
  for (const double target_z : {-4.0, 12.0}) {
    const Pose pose = look_at({1.0, 2.0, 3.0}, {1.0, 2.0, target_z});
    EXPECT_TRUE(is_rigid(pose));
    EXPECT_EQ(pose.linear().col(2), Eigen::Vector3d(0.0, 0.0, target_z < 3.0 ? -1.0 : 1.0));
    EXPECT_EQ(pose.linear().col(1), Eigen::Vector3d(-1.0, 0.0, 0.0));  // down in the image is -x
  }
  const Pose down = look_at({0.0, 0.0, 5.0}, {0.0, 0.0, 0.0});
  EXPECT_EQ(down.linear().col(0), Eigen::Vector3d(0.0, -1.0, 0.0));  // right in the image is -y
}

TEST(LookAt, IsVerticalUpToTheDocumentedSine) {
  const double inside = 0.5 * kVerticalSine;
  const double outside = 2.0 * kVerticalSine;
  // beside the vertical along y: within the threshold x is up, beyond it z, which is -y here
  const Pose vertical = look_at({0.0, 0.0, 1.0}, {0.0, inside, 0.0});
  const Pose slanted = look_at({0.0, 0.0, 1.0}, {0.0, outside, 0.0});
  EXPECT_LT((vertical.linear().col(1) + Eigen::Vector3d::UnitX()).norm(), 1e-5);
  EXPECT_LT((slanted.linear().col(1) + Eigen::Vector3d::UnitY()).norm(), 1e-5);
  EXPECT_TRUE(is_rigid(vertical));
  EXPECT_TRUE(is_rigid(slanted));
}

TEST(LookAt, WithoutUpVectorRejectsCoincidentPoints) {
  EXPECT_THROW(look_at({1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}), Error);
}

TEST(ToXyzWxyz, ListsPositionAndQuaternionWithPositiveW) {
  const Pose pose = make_pose({1.0, 2.0, 3.0}, Eigen::Quaterniond(-0.5, 0.5, 0.5, -0.5));
  PoseVector wanted;
  wanted << 1.0, 2.0, 3.0, 0.5, -0.5, -0.5, 0.5;
  EXPECT_LT((to_xyz_wxyz(pose) - wanted).norm(), 1e-15);
}

TEST(MakePose, NormalisesTheQuaternion) {
  const Pose pose = make_pose({0.0, 0.0, 0.0}, Eigen::Quaterniond(2.0, 0.0, 0.0, 2.0));
  EXPECT_LT((pose * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-15);
}

TEST(MakePose, AcceptsVeryLargeAndVerySmallQuaternions) {
  const double largest = std::numeric_limits<double>::max();
  const double smallest = std::numeric_limits<double>::denorm_min();
  for (const double length : {largest, 1e200, 1e-155, smallest}) {
    const Pose pose = make_pose({0.0, 0.0, 0.0}, Eigen::Quaterniond(length, 0.0, 0.0, length));
    EXPECT_LT((pose * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-15);
  }
}

TEST(MakePose, RejectsZeroAndNaN) {
  const double nan = kNaN;
  EXPECT_THROW(make_pose({0.0, 0.0, 0.0}, Eigen::Quaterniond(0.0, 0.0, 0.0, 0.0)), Error);
  EXPECT_THROW(make_pose({1e30, 0.0, 0.0}, Eigen::Quaterniond::Identity()), Error);
  EXPECT_THROW(look_at({1e30, 0.0, 0.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ()), Error);
  EXPECT_THROW(make_pose({nan, 0.0, 0.0}, Eigen::Quaterniond::Identity()), Error);
  EXPECT_THROW(make_pose({0.0, 0.0, 0.0}, Eigen::Quaterniond(nan, 0.0, 0.0, 1.0)), Error);
}

TEST(IsWithinReach, AcceptsFiniteCoordinatesUpToTheMaximumOnly) {
  EXPECT_TRUE(is_within_reach({kMaxCoordinate_m, -kMaxCoordinate_m, 0.0}));
  EXPECT_FALSE(is_within_reach({0.0, -1.0000001 * kMaxCoordinate_m, 0.0}));
  for (const double value : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_FALSE(is_within_reach({value, 0.0, 0.0}));
    EXPECT_FALSE(is_within_reach({0.0, 0.0, value}));
  }
}

TEST(IsRigid, RejectsMirrorsScalesAndNaN) {
  Pose pose = Pose::Identity();
  EXPECT_TRUE(is_rigid(pose));
  pose.linear()(0, 0) = -1.0;
  EXPECT_FALSE(is_rigid(pose));
  pose.linear()(0, 0) = 1.001;
  EXPECT_FALSE(is_rigid(pose));
  pose.linear()(0, 0) = kNaN;
  EXPECT_FALSE(is_rigid(pose));
}

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
