// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Ranges of surfaces that have a closed form, from the sensor's numbers to the frame.
#include <glidar/core/point_cloud.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <support/data.hpp>
#include <support/simulate.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

constexpr double kSingle = 1e-6;   // relative: vertices and cosines are in single precision
constexpr double kDouble = 1e-12;  // relative: corners that single precision holds exactly

Frame shoot(const Scene& scene, const Beams& beams, const Motion& motion) {
  const auto renderer = make_renderer(scene, {.threads = 2});
  const Sensor sensor;
  Frame frame;
  testing::simulate({scene, sensor, beams, motion, *renderer}, {.incidence = true}, frame);
  return frame;
}

/// The built-in plane, `half_m` to each side, at a pose.
Scene plane(const Pose& world_from_plane, double half_m) {
  Scene scene = testing::scene_of(make_builtin_model("plane"));
  scene.instances[0].scale = half_m;
  scene.instances[0].world_from_object = world_from_plane;
  return scene;
}

/// A camera at the world's origin that looks along z, as its frame does.
Pinhole camera(std::uint32_t size, double fov_rad) {
  return pinhole_from_fov(size, size, fov_rad);
}

TEST(ClosedForm, ALevelPlaneHasConstantDepthAndTheRangesOfAFloor) {
  Pose far = Pose::Identity();
  far.translation().z() = 7.0;
  const Scene wall = plane(far, 64.0);
  const Beams pixels = make_beams(camera(64, 1.2));
  const Frame image = shoot(wall, pixels, static_motion(wall, Pose::Identity()));
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    ASSERT_NEAR(depth_m(pixels, i, image.range_m[i]), 7.0, 7.0 * kDouble);
    const double cosine = pixels.directions[i].z();  // of the pixel's angle off the axis
    ASSERT_NEAR(image.range_m[i], 7.0 / cosine, 7.0 / cosine * kDouble);
  }
  Pose low = Pose::Identity();
  low.translation().z() = -1.8;
  const Scene floor = plane(low, 512.0);
  const Beams beams = make_beams(load_sensor_file(find_sensor_file("VLP-16")));
  const Frame turn = shoot(floor, beams, static_motion(floor, Pose::Identity()));
  std::size_t hits = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const double down = -beams.directions[i].z();
    if (down < 0.01) continue;
    const double height_m = 1.8 + beams.origins_m[i].z();
    const double range_m = height_m / down;  // R = h / (-n d)
    ASSERT_NEAR(turn.range_m[i], range_m, range_m * kDouble);
    ++hits;
  }
  EXPECT_EQ(hits, beams.size() / 2);  // eight of the sixteen beams look down
}

TEST(ClosedForm, ATiltedPlaneIsAffineInInverseDepth) {
  const Eigen::Vector3d n = Eigen::Vector3d(0.5, -0.3, 0.8).normalized();
  constexpr double kDistance_m = 4.0;
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), n).matrix();
  pose.translation() = kDistance_m * n;
  const Scene scene = plane(pose, 64.0);
  const Pinhole optics = camera(96, 0.9);
  const Beams beams = make_beams(optics);
  const Frame frame = shoot(scene, beams, static_motion(scene, Pose::Identity()));
  const PinholeIntrinsics& k = optics.intrinsics;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const double facing = n.dot(beams.directions[i]);
    ASSERT_NEAR(frame.range_m[i], kDistance_m / facing, kDistance_m / facing * kDouble);
    ASSERT_NEAR(frame.ground_truth.cos_incidence[i], facing, kSingle);
    const double x = plane_x(k, static_cast<std::uint32_t>(i % beams.cols));
    const double y = plane_y(k, static_cast<std::uint32_t>(i / beams.cols));
    const double inverse = (n.x() * x + n.y() * y + n.z()) / kDistance_m;  // affine in u and v
    ASSERT_NEAR(1.0 / depth_m(beams, i, frame.range_m[i]), inverse, inverse * kDouble);
  }
}

/// The range of the front of a sphere: R = d C - sqrt((d C)^2 - |C|^2 + r^2).
double range_of_sphere(const Eigen::Vector3d& direction, const Eigen::Vector3d& centre,
                       double radius) {
  const double along = direction.dot(centre);
  return along - std::sqrt(along * along - centre.squaredNorm() + radius * radius);
}

/// Beams from the origin at the vertices of instance 0 that lie on its near side.
Beams beams_at_vertices(const Scene& scene, double least_cosine) {
  Beams beams;
  beams.rows = 1;
  beams.frame_id = "test";
  const Eigen::Vector3d centre = scene.instances[0].world_from_object.translation();
  for (const Eigen::Vector3f& at : scene.meshes[0].positions_m) {
    const Eigen::Vector3d p =
        scene.instances[0].world_from_object * (scene.instances[0].scale * at.cast<double>());
    const Eigen::Vector3d outward = Eigen::Vector3d(p - centre).normalized();
    if (-outward.dot(p.normalized()) > least_cosine) beams.directions.push_back(p.normalized());
  }
  beams.cols = static_cast<std::uint32_t>(beams.directions.size());
  return beams;
}

TEST(ClosedForm, ASphereHasTheExactRangesAtItsVertices) {
  Scene scene = testing::scene_of(make_builtin_model("sphere"));
  const Eigen::Vector3d centre(1.0, -0.5, 6.0);
  scene.instances[0].scale = 1.5;
  scene.instances[0].world_from_object.translation() = centre;
  const Beams beams = beams_at_vertices(scene, 0.1);
  ASSERT_GT(beams.size(), 800U);
  const Frame frame = shoot(scene, beams, static_motion(scene, Pose::Identity()));
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const double range_m = range_of_sphere(beams.directions[i], centre, 1.5);
    ASSERT_NEAR(frame.range_m[i], range_m, 3.0 * range_m * kSingle)
        << i;  // oblique by up to 84 deg
  }
}

TEST(ClosedForm, ASphereHasItsSilhouetteAndShareOfBeams) {
  Scene scene = testing::scene_of(make_builtin_model("sphere"));
  const Eigen::Vector3d centre(0.0, 0.0, 5.0);
  scene.instances[0].world_from_object.translation() = centre;
  const Pinhole optics = camera(400, 0.6);
  const Beams beams = make_beams(optics);
  const Frame frame = shoot(scene, beams, static_motion(scene, Pose::Identity()));
  const double half_angle = std::asin(1.0 / 5.0);
  double pixels = 0.0;
  double solid_angle = 0.0;
  double widest = 0.0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (frame.status[i] != Status::hit) continue;
    const double cosine = beams.directions[i].z();
    pixels += 1.0;
    solid_angle += cosine * cosine * cosine;  // of a pixel, times the focal length squared
    widest = std::max(widest, std::acos(cosine));
    const double range_m = range_of_sphere(beams.directions[i], centre, 1.0);
    // the mesh is inside the sphere, by 0.0012 of its radius at most
    if (frame.ground_truth.cos_incidence[i] > 0.2F) {
      ASSERT_GT(frame.range_m[i], range_m * (1.0 - kSingle));
      ASSERT_LT(frame.range_m[i], range_m + 0.0012 / 0.15);
    }
  }
  const double focal_px = optics.intrinsics.fx;
  const double radius_px = focal_px * std::tan(half_angle);
  constexpr double kMesh = 0.003;  // what the mesh is smaller, and pixels on the border
  EXPECT_NEAR(pixels / (std::numbers::pi * radius_px * radius_px), 1.0, kMesh);
  EXPECT_NEAR(widest / half_angle, 1.0, kMesh);
  const double cap = 2.0 * std::numbers::pi * (1.0 - std::cos(half_angle));
  EXPECT_NEAR(solid_angle / (focal_px * focal_px) / cap, 1.0, kMesh);
}

/// A cylinder about z as a prism; its edges lie on the cylinder.
Scene cylinder(double radius_m, std::uint32_t sides) {
  Scene scene = testing::scene_of(make_builtin_model("plane"));
  Mesh& mesh = scene.meshes[0];
  mesh = {};
  mesh.name = "cylinder";
  for (std::uint32_t k = 0; k < sides; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / sides;
    for (const float z : {-50.0F, 50.0F}) {
      mesh.positions_m.emplace_back(static_cast<float>(radius_m * std::cos(angle)),
                                    static_cast<float>(radius_m * std::sin(angle)), z);
    }
    const std::uint32_t a = 2 * k;
    const std::uint32_t b = 2 * ((k + 1) % sides);
    mesh.triangles.push_back({a, b, b + 1});
    mesh.triangles.push_back({a, b + 1, a + 1});
  }
  return scene;
}

TEST(ClosedForm, ACylinderHasTheExactRangesFromInside) {
  constexpr double kRadius_m = 3.0;
  constexpr std::uint32_t kSides = 8192;
  Scene scene = cylinder(kRadius_m, kSides);
  Pose pose = Pose::Identity();
  const Eigen::Vector3d eye(0.7, -1.1, 0.4);
  pose.translation() = eye;
  const Beams beams = make_beams(load_sensor_file(find_sensor_file("VLP-16")));
  const Frame frame = shoot(scene, beams, static_motion(scene, pose));
  // a chord of angle a is up to r (1 - cos(a / 2)) inside the cylinder
  const double inside_m = kRadius_m * (1.0 - std::cos(std::numbers::pi / kSides));
  for (std::size_t i = 0; i < beams.size(); ++i) {
    // |(o + R d)_xy| = radius
    const Eigen::Vector2d d = beams.directions[i].head<2>();
    const double half_b = eye.head<2>().dot(d);
    const double c = eye.head<2>().squaredNorm() - kRadius_m * kRadius_m;
    const double range_m =
        (-half_b + std::sqrt(half_b * half_b - d.squaredNorm() * c)) / d.squaredNorm();
    ASSERT_LT(inside_m / range_m, 0.5 * kSingle);
    ASSERT_NEAR(frame.range_m[i], range_m, range_m * kSingle) << i;
  }
}

TEST(ClosedForm, PointsOfAMovingLidarAreOnTheWallAfterDeskewingOnly) {
  constexpr double kSpeed_m_s = 10.0;
  Pose pose = Pose::Identity();
  pose.linear() =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitX())
          .matrix();
  pose.translation().x() = 32.0;
  const Scene wall = plane(pose, 4096.0);
  const Beams beams = make_beams(load_sensor_file(find_sensor_file("VLP-16")));
  Motion motion = static_motion(wall, Pose::Identity());
  motion.world_from_sensor = ConstantTwist{.linear_m_s = {kSpeed_m_s, 0.0, 0.0}};
  const Frame frame = shoot(wall, beams, motion);
  std::array<PointCloud, 2> clouds;
  for (const bool deskew : {false, true}) {
    make_point_cloud(
        frame, beams, wall,
        {.frame_id = "world", .cloud_from_sensor = frame.world_from_sensor, .deskew = deskew},
        std::vector<std::string>{"xyz"}, clouds.at(deskew ? 1 : 0));
  }
  const auto x_of = [&](std::size_t cloud, std::size_t beam) {
    return std::get<std::vector<double>>(clouds.at(cloud).columns[0].values)[3 * beam];
  };
  std::size_t hits = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (frame.status[i] != Status::hit || frame.range_m[i] > 1000.0) continue;
    ++hits;
    const double way_m = kSpeed_m_s * 1e-9 * beams.times_ns[i];
    ASSERT_NEAR(x_of(1, i), 32.0, 1e-9);
    ASSERT_NEAR(32.0 - x_of(0, i), way_m, 1e-6);
  }
  EXPECT_GT(hits, beams.size() / 3);
}

}  // namespace
}  // namespace glidar
