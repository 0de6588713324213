// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/placement.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/output_frame.hpp>
#include <glidar/io/model/model.hpp>
#include <glidar/sensor/optics/pinhole.hpp>
#include <glidar/sensor/optics/spinning.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace glidar::app {
namespace {

constexpr double kExact = 1e-12;

Scene one_triangle() {
  Scene scene;
  Mesh mesh;
  mesh.positions_m = {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}};
  mesh.triangles = {{0, 1, 2}};
  scene.meshes.push_back(mesh);
  scene.sources.emplace_back();
  scene.materials.emplace_back();
  scene.instances.push_back({.name = "triangle", .materials = {0}});
  return scene;
}

Beams camera() {
  return make_beams(pinhole_from_fov(8, 8, 0.35));
}

/// A point of the object in the sensor frame of the original GLIDAR.
Eigen::Vector3d woods2016_point(const PoseFlags& flags, const Eigen::Vector3d& object_point) {
  Scene scene = one_triangle();
  pose_model(flags, scene);
  const Pose world_from_sensor = pose_sensor(flags, {}, camera(), scene);
  return woods2016_from_optical() * world_from_sensor.inverse() *
         scene.instances[0].world_from_object * object_point;
}

TEST(LegacyPose, IdentityPlacesTheObjectOnTheBoresightAtDistanceD) {
  const Eigen::Vector3d p = woods2016_point({.camera_z_m = 7.0}, {0.1, 0.2, 0.3});
  EXPECT_LT((p - Eigen::Vector3d(0.1, 0.2, 7.3)).norm(), kExact);
}

TEST(LegacyPose, CameraAttitudeAloneKeepsTheDefaultDistance) {
  const Eigen::Vector3d p =
      woods2016_point({.camera_q = Eigen::Quaterniond::Identity()}, {0.0, 0.0, 0.0});
  EXPECT_LT((p - Eigen::Vector3d(0.0, 0.0, 1000.0)).norm(), kExact);
}

TEST(LegacyPose, ModelQuaternionRotatesInertialVectorsIntoTheBody) {
  // 90 degrees about z: R(q) x = y, so that the body's y axis is along the inertial x
  const double h = std::sqrt(0.5);
  const PoseFlags flags{.model_q = Eigen::Quaterniond(h, 0.0, 0.0, h), .camera_z_m = 5.0};
  const Eigen::Vector3d p = woods2016_point(flags, {0.0, 1.0, 0.0});
  EXPECT_LT((p - Eigen::Vector3d(1.0, 0.0, 5.0)).norm(), kExact);
}

TEST(LegacyPose, SensorQuaternionRotatesInertialVectorsIntoTheSensor) {
  // R(q) z = x: the object, straight ahead of an identity sensor, appears on the sensor's x (left)
  const double h = std::sqrt(0.5);
  const PoseFlags flags{.camera_q = Eigen::Quaterniond(h, 0.0, h, 0.0), .camera_z_m = 5.0};
  const Eigen::Vector3d p = woods2016_point(flags, {0.0, 0.0, 0.0});
  EXPECT_LT((p - Eigen::Vector3d(5.0, 0.0, 0.0)).norm(), kExact);
}

TEST(LegacyPose, GeneralAttitudesFollowTheFormula) {
  const Eigen::Quaterniond model_q = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized();
  const Eigen::Quaterniond camera_q = Eigen::Quaterniond(0.9, 0.1, -0.2, 0.3).normalized();
  const PoseFlags flags{.model_q = model_q, .camera_q = camera_q, .camera_z_m = 12.0};
  const Eigen::Vector3d object_point(0.4, -0.6, 1.1);
  const Eigen::Vector3d expected =
      camera_q * (model_q.conjugate() * object_point + Eigen::Vector3d(0.0, 0.0, 12.0));
  EXPECT_LT((woods2016_point(flags, object_point) - expected).norm(), kExact);
}

TEST(LegacyPose, LegacyFrameIsTheOpticalFrameRotatedAboutTheBoresight) {
  const Eigen::Vector3d legacy = woods2016_from_optical() * Eigen::Vector3d(1.0, 2.0, 3.0);
  EXPECT_EQ(legacy, Eigen::Vector3d(-1.0, -2.0, 3.0));
  EXPECT_TRUE(is_rigid(woods2016_from_optical()));
}

TEST(PoseOptions, EyeLooksAtTheTarget) {
  const Scene scene = one_triangle();
  const Pose pose = pose_sensor({.eye_m = Eigen::Vector3d(1.0, 2.0, 3.0),
                                 .target_m = Eigen::Vector3d(1.0, 2.0, 9.0),
                                 .up = Eigen::Vector3d(0.0, 1.0, 0.0)},
                                {}, camera(), scene);
  EXPECT_LT(
      (pose.inverse() * Eigen::Vector3d(1.0, 3.0, 5.0) - Eigen::Vector3d(0.0, -1.0, 2.0)).norm(),
      kExact);
}

TEST(PoseOptions, EyeAloneLooksAtTheCentreOfTheScene) {
  const Pose pose =
      pose_sensor({.eye_m = Eigen::Vector3d(3.0, -4.0, 2.0)}, {}, camera(), one_triangle());
  const Eigen::Vector3d middle = pose.inverse() * Eigen::Vector3d(0.5, 0.5, 0.0);
  EXPECT_NEAR(middle.x(), 0.0, kExact);
  EXPECT_NEAR(middle.y(), 0.0, kExact);
  EXPECT_GT(middle.z(), 0.0);
}

TEST(PoseOptions, SensorPoseIsUnchanged) {
  const Pose given = make_pose({1.0, 2.0, 3.0}, Eigen::Quaterniond(0.0, 0.0, 0.0, 1.0));
  const Pose pose = pose_sensor({.world_from_sensor = given}, {}, camera(), one_triangle());
  const Eigen::Vector3d world = pose * Eigen::Vector3d(1.0, 0.0, 0.0);
  EXPECT_LT((world - Eigen::Vector3d(0.0, 2.0, 3.0)).norm(), kExact);
}

TEST(PoseOptions, FlagsOverrideTheSceneFileWhichOverridesFraming) {
  const Scene scene = one_triangle();
  const Pose from_file = make_pose({7.0, 8.0, 9.0}, Eigen::Quaterniond::Identity());
  EXPECT_EQ(pose_sensor({}, {from_file}, camera(), scene).translation(), from_file.translation());
  EXPECT_EQ(pose_sensor({.eye_m = Eigen::Vector3d(1.0, 2.0, 3.0)}, {from_file}, camera(), scene)
                .translation(),
            Eigen::Vector3d(1.0, 2.0, 3.0));
  const Pose framed = pose_sensor({}, {}, camera(), scene);
  EXPECT_GT((framed.inverse() * Eigen::Vector3d(0.5, 0.5, 0.0)).z(), 1.0);
}

TEST(PoseOptions, ScaleIsThatOfTheInstance) {
  Scene scene = one_triangle();
  pose_model({.scale = Eigen::Vector3d::Constant(2.5)}, scene);
  EXPECT_EQ(scene.instances[0].scale, 2.5);
}

TEST(PoseOptions, ScaleHasThreeFactorsAndMirrors) {
  Scene scene = one_triangle();
  scene.instances[0].scale = 2.0;
  pose_model({.scale = Eigen::Vector3d(1.0, -2.0, 0.5)}, scene);
  EXPECT_EQ(scale_of(scene, scene.instances[0]), Eigen::Vector3d(2.0, -4.0, 1.0));
  EXPECT_THAT(error_text([&] { pose_model({.scale = Eigen::Vector3d(1.0, 1e15, 1.0)}, scene); }),
              ::testing::StartsWith("--scale, scale: 2, -4e+15, 1"));
}

void expect_sensor_error(const PoseFlags& flags, const std::string& text) {
  EXPECT_THAT(error_text([&] { pose_sensor(flags, {}, camera(), one_triangle()); }),
              ::testing::HasSubstr(text));
}

TEST(PoseOptions, ErrorsNameTheOptions) {
  const Eigen::Vector3d on_x(5.0, 0.0, 0.0);
  const Eigen::Vector3d on_z(0.0, 0.0, 5.0);
  expect_sensor_error({.up = on_x, .camera_z_m = 5.0}, "--up-vector");
  expect_sensor_error({.eye_m = on_x, .target_m = on_x}, "--eye: '5,0,0' is the point");
  expect_sensor_error({.eye_m = on_z, .target_m = Eigen::Vector3d(0.0, 0.0, 0.0), .up = on_z},
                      "for example --up-vector 1,0,0");
  expect_sensor_error({.eye_m = on_x, .up = Eigen::Vector3d(0.0, 0.0, 0.0)},
                      "--up-vector: the sensor looks");
  expect_sensor_error({.up = Eigen::Vector3d(2.0, -3.0, 2.0)}, "parallel to its up vector 2,-3,2");
}

TEST(PoseOptions, ModelOptionsAreRefusedForScenesOfSeveralObjects) {
  Scene scene = one_triangle();
  scene.instances.push_back(scene.instances[0]);
  EXPECT_THROW(pose_model({.model_q = Eigen::Quaterniond::Identity()}, scene), Error);
  EXPECT_THROW(pose_model({.scale = Eigen::Vector3d::Constant(2.0)}, scene), Error);
  EXPECT_NO_THROW(pose_model({}, scene));
}

TEST(CloudFrames, HaveTheAxesOfTheirNames) {
  const Beams beams = camera();
  const Eigen::Vector3d right_down_forward(1.0, 2.0, 3.0);
  const Pose pose = make_pose({10.0, 0.0, 0.0}, Eigen::Quaterniond::Identity());
  const auto in = [&](const std::string& name) -> Eigen::Vector3d {
    const OutputFrame frame = output_frame(name, beams, pose);
    EXPECT_TRUE(is_rigid(frame.cloud_from_sensor));
    return frame.cloud_from_sensor * right_down_forward;
  };
  EXPECT_EQ(in("optical"), right_down_forward);
  EXPECT_EQ(in("ros"), Eigen::Vector3d(3.0, -1.0, -2.0));
  EXPECT_EQ(in("gl"), Eigen::Vector3d(1.0, -2.0, -3.0));
  EXPECT_EQ(in("legacy"), Eigen::Vector3d(-1.0, -2.0, 3.0));
  EXPECT_EQ(in("world"), Eigen::Vector3d(11.0, 2.0, 3.0));
}

/// Beams of a 360 degree LiDAR between these elevations.
Beams lidar(double low_rad, double high_rad) {
  Spinning spinning;
  spinning.channels.resize(2);
  spinning.channels[0].elevation_rad = low_rad;
  spinning.channels[1].elevation_rad = high_rad;
  spinning.columns_per_turn = 36;
  return make_beams(spinning, {0, 100'000'000});
}

TEST(CloudFrames, OfALidarHaveTheSameAxes) {
  const Beams beams = lidar(-0.2, 0.2);
  const Eigen::Vector3d forward_left_up(3.0, -1.0, -2.0);
  const auto in = [&](const std::string& name) -> Eigen::Vector3d {
    return output_frame(name, beams, Pose::Identity()).cloud_from_sensor * forward_left_up;
  };
  EXPECT_EQ(in("sensor"), forward_left_up);
  EXPECT_EQ(in("ros"), forward_left_up);
  EXPECT_EQ(in("optical"), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(in("gl"), Eigen::Vector3d(1.0, -2.0, -3.0));
  EXPECT_EQ(in("legacy"), Eigen::Vector3d(-1.0, -2.0, 3.0));
  EXPECT_EQ(output_frame("sensor", beams, Pose::Identity()).frame_id, "lidar_frame");
}

TEST(LidarPose, EyeAndTargetAimTheXAxis) {
  const Scene scene = one_triangle();
  const Pose pose = pose_sensor(
      {.eye_m = Eigen::Vector3d(1.0, 2.0, 3.0), .target_m = Eigen::Vector3d(5.0, 2.0, 6.0)}, {},
      lidar(-0.2, 0.2), scene);
  EXPECT_LT((pose * Eigen::Vector3d(5.0, 0.0, 0.0) - Eigen::Vector3d(5.0, 2.0, 6.0)).norm(),
            kExact);
  EXPECT_NEAR((pose.linear() * Eigen::Vector3d::UnitY()).z(), 0.0, kExact);  // no roll
}

TEST(LidarPose, EyeAloneKeepsTheAxesOfTheWorldForAnyScene) {
  Scene scene = one_triangle();
  const Pose alone =
      pose_sensor({.eye_m = Eigen::Vector3d(4.0, 0.5, 7.0)}, {}, lidar(-0.2, 0.2), scene);
  EXPECT_EQ(alone.linear(), Eigen::Matrix3d::Identity());
  EXPECT_EQ(alone.translation(), Eigen::Vector3d(4.0, 0.5, 7.0));
  scene.instances.push_back(scene.instances[0]);
  scene.instances[1].world_from_object.translation() = Eigen::Vector3d(50.0, 80.0, 0.0);
  const Pose among =
      pose_sensor({.eye_m = Eigen::Vector3d(4.0, 0.5, 7.0)}, {}, lidar(-0.2, 0.2), scene);
  EXPECT_EQ(among.matrix(), alone.matrix());
}

TEST(LidarPose, EyeWithUpVectorTiltsItWithTheHeadingClosestToX) {
  const Pose pose =
      pose_sensor({.eye_m = Eigen::Vector3d(0.0, 0.0, 1.0), .up = Eigen::Vector3d(0.0, -1.0, 1.0)},
                  {}, lidar(-0.2, 0.2), {});
  EXPECT_LT((pose.linear().col(0) - Eigen::Vector3d::UnitX()).norm(), kExact);
  EXPECT_LT((pose.linear().col(2) - Eigen::Vector3d(0.0, -1.0, 1.0).normalized()).norm(), kExact);
  const Pose leaning =
      pose_sensor({.eye_m = Eigen::Vector3d(0.0, 0.0, 1.0), .up = Eigen::Vector3d(1.0, 0.0, 1.0)},
                  {}, lidar(-0.2, 0.2), {});
  EXPECT_TRUE(is_rigid(leaning));
  EXPECT_LT((leaning.linear().col(0) - Eigen::Vector3d(1.0, 0.0, -1.0).normalized()).norm(),
            kExact);
  EXPECT_THROW(
      pose_sensor({.eye_m = Eigen::Vector3d(0.0, 0.0, 1.0), .up = Eigen::Vector3d(1.0, 0.0, 0.0)},
                  {}, lidar(-0.2, 0.2), {}),
      Error);
}

TEST(LidarPose, TargetStraightBelowUsesTheWorldsXAsUp) {
  const Pose pose = pose_sensor(
      {.eye_m = Eigen::Vector3d(1.0, 2.0, 9.0), .target_m = Eigen::Vector3d(1.0, 2.0, 0.0)}, {},
      lidar(-0.2, 0.2), one_triangle());
  EXPECT_EQ(pose.linear().col(0), Eigen::Vector3d(0.0, 0.0, -1.0));
  EXPECT_EQ(pose.linear().col(2), Eigen::Vector3d(1.0, 0.0, 0.0));
}

TEST(PoseOptions, CameraStraightAboveLooksDownWithTheWorldsXUp) {
  const Pose pose =
      pose_sensor({.eye_m = Eigen::Vector3d(0.5, 0.5, 6.0)}, {}, camera(), one_triangle());
  EXPECT_EQ(pose.linear().col(2), Eigen::Vector3d(0.0, 0.0, -1.0));
  EXPECT_EQ(pose.linear().col(1), Eigen::Vector3d(-1.0, 0.0, 0.0));
}

TEST(LidarPose, LookAtOfASceneFileAimsTheXAxis) {
  const Pose optical = look_at({0, 0, 0}, {0, 3, 0}, Eigen::Vector3d::UnitZ());
  const Scene scene = one_triangle();
  const Pose aimed = pose_sensor({}, {optical, true}, lidar(-0.2, 0.2), scene);
  EXPECT_LT((aimed * Eigen::Vector3d(3, 0, 0) - Eigen::Vector3d(0, 3, 0)).norm(), kExact);
  const Pose given = pose_sensor({}, {optical, false}, lidar(-0.2, 0.2), scene);
  EXPECT_TRUE(given.isApprox(optical));
}

TEST(LidarPose, WithoutPoseItIsBesideTheSceneWithinItsElevations) {
  const Scene scene = one_triangle();
  for (const auto& [low_rad, high_rad] :
       {std::pair{-0.26, 0.26}, std::pair{-0.53, 0.19}, std::pair{0.0, 0.0}}) {
    const Pose pose = pose_sensor({}, {}, lidar(low_rad, high_rad), scene);
    EXPECT_LT((pose.linear() * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitZ()).norm(), kExact);
    const Eigen::AlignedBox3d box = bounds(scene);
    const Eigen::Vector3d middle = pose.inverse() * box.center();
    EXPECT_GT(middle.x(), 0.0);
    EXPECT_NEAR(middle.y(), 0.0, kExact);
    const double elevation_rad = std::asin(middle.z() / middle.norm());
    EXPECT_NEAR(elevation_rad, 0.5 * (low_rad + high_rad), kExact);
    const double half_rad = std::asin(0.5 * box.diagonal().norm() / middle.norm());
    EXPECT_NEAR(half_rad, low_rad < high_rad ? 0.5 * (high_rad - low_rad) : std::numbers::pi / 6.0,
                kExact);
  }
}

}  // namespace
}  // namespace glidar::app
