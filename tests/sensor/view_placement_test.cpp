// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/sensor/optics/pinhole.hpp>
#include <glidar/sensor/view_placement.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace glidar {
namespace {

const Eigen::Vector3d kFrom(2.0, -3.0, 2.0);
const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

/// A tetrahedron that is not symmetric, and far from the world's origin.
Scene tetrahedron(const Eigen::Vector3d& stretch = {1.0, 1.0, 1.0}) {
  Scene scene;
  Mesh mesh;
  mesh.origin_m = {100.0, -20.0, 5.0};
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(2.0, 0.1, 0.0),
        Eigen::Vector3d(0.3, 1.5, 0.2), Eigen::Vector3d(0.1, 0.4, 1.0)}) {
    mesh.positions_m.emplace_back(p.cwiseProduct(stretch).cast<float>());
  }
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  scene.meshes.push_back(mesh);
  scene.sources.emplace_back();
  scene.materials.emplace_back();
  Instance instance;
  instance.scale = 3.0;
  instance.world_from_object = make_pose({1.0, 2.0, 3.0}, Eigen::Quaterniond(0.5, 0.1, -0.7, 0.3));
  instance.materials = {0};
  scene.instances.push_back(instance);
  return scene;
}

/// All vertices in the camera's frame.
std::vector<Eigen::Vector3d> seen(const Scene& scene, const Pose& world_from_sensor) {
  std::vector<Eigen::Vector3d> points;
  const Instance& instance = scene.instances[0];
  const Mesh& mesh = scene.meshes[0];
  for (const Eigen::Vector3f& p : mesh.positions_m) {
    const Eigen::Vector3d object = instance.scale * (mesh.origin_m + p.cast<double>());
    points.emplace_back(world_from_sensor.inverse() * (instance.world_from_object * object));
  }
  return points;
}

/// The bounding box of the vertices in the image, -1..1 from edge to edge.
Eigen::AlignedBox2d filled(const PinholeIntrinsics& k, const std::vector<Eigen::Vector3d>& points) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& p : points) {
    EXPECT_GT(p.z(), 0.0);
    const double u = k.fx * p.x() / p.z() + k.cx;
    const double v = k.fy * p.y() / p.z() + k.cy;
    box.extend(Eigen::Vector2d(2.0 * u / k.width - 1.0, 2.0 * v / k.height - 1.0));
  }
  return box;
}

void expect_fills(const Pinhole& camera, const Scene& scene) {
  const Pose pose = fit_camera_to_scene(make_beams(camera), scene, kFrom, kUp);
  EXPECT_TRUE(is_rigid(pose));
  const Eigen::AlignedBox2d box = filled(camera.intrinsics, seen(scene, pose));
  const double inside = 1.0 - kFramingMargin;
  EXPECT_LT(box.max().maxCoeff(), inside + 1e-9);
  EXPECT_GT(box.min().minCoeff(), -inside - 1e-9);
  // one axis is filled from margin to margin, the other is centred in its plane
  EXPECT_NEAR((box.max() - box.min()).maxCoeff(), 2.0 * inside, 1e-9);
}

TEST(Framing, SquareImageIsFilledToTheMargin) {
  expect_fills(pinhole_from_fov(64, 64, 0.35), tetrahedron());
}

TEST(Framing, WideAndTallImagesAreFilledToTheMargin) {
  expect_fills(pinhole_from_fov(400, 20, 0.35), tetrahedron());
  expect_fills(pinhole_from_fov(20, 400, 0.35), tetrahedron());
  expect_fills(pinhole_from_fov(400, 20, 0.35), tetrahedron({0.01, 0.01, 20.0}));
  expect_fills(pinhole_from_fov(20, 400, 0.35), tetrahedron({30.0, 0.01, 0.01}));
}

TEST(Framing, NarrowAndWideFieldsAreFilledToTheMargin) {
  expect_fills(pinhole_from_fov(64, 48, 1e-4), tetrahedron());
  expect_fills(pinhole_from_fov(64, 48, 1.2), tetrahedron());
}

// A view so wide could be filled only from within the box, where only parts of the model are
// visible.
TEST(Framing, VeryWideFieldsStayOutsideTheBoxAndContainEverything) {
  for (const double fov_rad : {2.0, 2.8, 3.12, 3.1415}) {
    const Pinhole camera = pinhole_from_fov(64, 48, fov_rad);
    const Scene scene = tetrahedron();
    const Pose pose = fit_camera_to_scene(make_beams(camera), scene, kFrom, kUp);
    const Eigen::AlignedBox3d box = bounds(scene);
    const double size = box.diagonal().norm();
    EXPECT_GT(box.exteriorDistance(Eigen::Vector3d(pose.translation())), 0.009 * size) << fov_rad;
    const Eigen::AlignedBox2d image = filled(camera.intrinsics, seen(scene, pose));
    EXPECT_LT(image.max().cwiseAbs().maxCoeff(), 1.0) << fov_rad;
    EXPECT_LT(image.min().cwiseAbs().maxCoeff(), 1.0) << fov_rad;
  }
}

TEST(Framing, FisheyeStaysOutsideTheBox) {
  Pinhole camera;
  camera.intrinsics = {.width = 80, .height = 60, .fx = 20.0, .fy = 20.0, .cx = 40.0, .cy = 30.0};
  camera.distortion = Fisheye{};
  const Scene scene = tetrahedron({1.0, 1.0, 0.05});
  const Pose pose = fit_camera_to_scene(make_beams(camera), scene, kFrom, kUp);
  EXPECT_FALSE(bounds(scene).contains(Eigen::Vector3d(pose.translation())));
}

TEST(Framing, PrincipalPointOffTheCentreIsFilledToTheMargin) {
  Pinhole camera = pinhole_from_fov(64, 48, 0.5);
  camera.intrinsics.cx = -100.0;
  camera.intrinsics.cy = 40.0;
  camera.intrinsics.fy *= 1.3;
  expect_fills(camera, tetrahedron());
}

TEST(Framing, OnePixelContainsEverything) {
  expect_fills(pinhole_from_fov(1, 1, 0.2), tetrahedron());
}

TEST(Framing, HasTheRequestedDirectionAndUpVector) {
  const Scene scene = tetrahedron();
  const Pose pose =
      fit_camera_to_scene(make_beams(pinhole_from_fov(64, 64, 0.35)), scene, kFrom, kUp);
  const Eigen::Vector3d forward = pose.linear().col(2);
  EXPECT_LT((forward + kFrom.normalized()).norm(), 1e-12);
  EXPECT_LT(pose.linear().col(1).z(), 0.0);  // image down is not world up
  EXPECT_NEAR(pose.linear().col(0).z(), 0.0, 1e-12);
}

TEST(Framing, FlatObjectSeenEdgeOnIsInFront) {
  Scene scene = tetrahedron({1.0, 0.0, 0.0});  // a line
  scene.instances[0].world_from_object = Pose::Identity();
  const Pose pose = fit_camera_to_scene(make_beams(pinhole_from_fov(64, 64, 0.35)), scene,
                                        Eigen::Vector3d::UnitX(), kUp);
  for (const Eigen::Vector3d& p : seen(scene, pose)) EXPECT_GT(p.z(), 0.0);
}

/// The widest angle of a vertex from the boresight, as a part of `half_angle_rad`.
double widest(const std::vector<Eigen::Vector3d>& points) {
  double angle_rad = 0.0;
  for (const Eigen::Vector3d& p : points) {
    angle_rad = std::max(angle_rad, std::atan2(p.head<2>().norm(), p.z()));
  }
  return angle_rad;
}

TEST(Framing, DistortedImageContainsEverythingAndIsNearlyFilled) {
  Pinhole camera = pinhole_from_fov(64, 48, 1.0);
  for (const double k1 : {-0.2, 0.2}) {
    camera.distortion = RadialTangential{.k1 = k1, .p1 = 0.01};
    const Beams beams = make_beams(camera);
    ASSERT_FALSE(beams.pinhole.has_value());
    const Scene scene = tetrahedron();
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3d& p : seen(scene, fit_camera_to_scene(beams, scene, kFrom, kUp))) {
      ASSERT_GT(p.z(), 0.0);
      const Eigen::Vector2d q = p.hnormalized();
      const double radial = 1.0 + k1 * q.squaredNorm();
      const PinholeIntrinsics& k = camera.intrinsics;
      const double x = q.x() * radial + 0.02 * q.x() * q.y();
      const double y = q.y() * radial + 0.01 * (q.squaredNorm() + 2.0 * q.y() * q.y());
      box.extend(Eigen::Vector2d(2.0 * (k.fx * x + k.cx) / k.width - 1.0,
                                 2.0 * (k.fy * y + k.cy) / k.height - 1.0));
    }
    EXPECT_LT(box.max().maxCoeff(), 1.0);
    EXPECT_GT(box.min().minCoeff(), -1.0);
    EXPECT_GT((box.max() - box.min()).maxCoeff(), 1.5);
  }
}

TEST(Framing, FisheyeOfMoreThanHalfASphereContainsEverything) {
  Pinhole camera;
  camera.intrinsics = {.width = 80, .height = 60, .fx = 20.0, .fy = 20.0, .cx = 40.0, .cy = 30.0};
  camera.distortion = Fisheye{};  // 30 pixels from the middle are 1.5 rad
  const Beams beams = make_beams(camera);
  const Scene scene = tetrahedron();
  const double angle_rad = widest(seen(scene, fit_camera_to_scene(beams, scene, kFrom, kUp)));
  EXPECT_LT(angle_rad, std::numbers::pi / 3.0);
  EXPECT_GT(angle_rad, 0.8);
}

void expect_error(const Beams& beams, const Scene& scene, const std::string& text) {
  EXPECT_THAT(error_text([&] { fit_camera_to_scene(beams, scene, kFrom, kUp); }),
              ::testing::HasSubstr(text));
}

TEST(Framing, ReportsWhyItCannotFrame) {
  const Beams beams = make_beams(pinhole_from_fov(8, 8, 0.35));
  expect_error(beams, Scene{}, "no triangles");
  expect_error(beams, tetrahedron({0.0, 0.0, 0.0}), "one point");
  Beams sideways = beams;
  sideways.boresight = Eigen::Vector3d::UnitX();
  expect_error(sideways, tetrahedron(), "boresight +z");
  Beams single = beams;
  single.pinhole.reset();
  single.rows = single.cols = 1;
  single.directions.resize(1);
  expect_error(single, tetrahedron(), "no area");
}

}  // namespace
}  // namespace glidar
