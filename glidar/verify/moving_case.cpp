// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/moving_case.hpp>

#include <glidar/simulate/moving_cast.hpp>
#include <glidar/verify/comparison.hpp>
#include <glidar/verify/probes.hpp>

#include <cmath>

namespace glidar {
namespace {

using RealMatrix = Eigen::Matrix<Real, 3, 3>;

constexpr std::int64_t kStamp_ns = 500'000'000;
constexpr std::uint32_t kStep_ns = 25'000;  // between beams: a frame takes 0.1 s
// A few hundred roundings of double: rays nearer to a silhouette are not compared.
constexpr double kEdgeTolerance_m = 1e-12;

RealMatrix cross_matrix(const RealVector& w) {
  RealMatrix matrix;
  matrix << 0.0L, -w.z(), w.y(), w.z(), 0.0L, -w.x(), -w.y(), w.x(), 0.0L;
  return matrix;
}

/// A screw motion after a time (K. M. Lynch and F. C. Park, "Modern Robotics" (2017), equation
/// 3.88), in extended precision.
ExactPose moved(const ConstantTwist& twist, Real seconds) {
  const RealVector angle = twist.angular_rad_s.cast<Real>() * seconds;
  const Real theta = angle.norm();
  const RealMatrix w = cross_matrix(angle / theta);
  const RealMatrix turn =
      RealMatrix::Identity() + std::sin(theta) * w + (1.0L - std::cos(theta)) * w * w;
  const RealMatrix path = RealMatrix::Identity() + (1.0L - std::cos(theta)) / theta * w +
                          (theta - std::sin(theta)) / theta * w * w;
  const RealMatrix start = twist.pose.linear().cast<Real>();
  return {.rotation = start * turn,
          .shift = twist.pose.translation().cast<Real>() +
                   start * (path * (twist.linear_m_s.cast<Real>() * seconds))};
}

/// The pose of an object relative to a sensor.
ExactPose relative_to_sensor(const ExactPose& sensor, const ExactPose& object) {
  return {.rotation = sensor.rotation.transpose() * object.rotation,
          .shift = sensor.rotation.transpose() * (object.shift - sensor.shift)};
}

/// A moving sensor, a moving target and a static object.
struct MovingScene {
  ConstantTwist sensor;
  ConstantTwist target;
  Pose world_from_rest;
  double target_scale = 2.0;
  double rest_scale = 1.5;
};

MovingScene make_moving_scene() {
  constexpr std::uint32_t kNumber = 90050;
  MovingScene moving;
  moving.sensor = {.pose = make_pose({0.5, -0.25, 0.0}, Eigen::Quaterniond::Identity()),
                   .angular_rad_s = {0.3, -0.2, 0.5},
                   .linear_m_s = {1.0, -0.5, 2.0}};
  moving.target = {.pose = make_pose({0.0, 0.5, 12.0}, random_rotation(probe_uniforms(kNumber, 0))),
                   .angular_rad_s = {-0.4, 0.7, 0.2},
                   .linear_m_s = {3.0, -1.0, 0.5}};
  moving.world_from_rest = make_pose({3.0, 1.5, 9.0}, random_rotation(probe_uniforms(kNumber, 1)));
  return moving;
}

/// The shapes relative to the sensor at a beam's firing time.
ExactScene scene_at(const MovingScene& moving, const std::vector<Shape>& shapes,
                    std::uint32_t time_ns) {
  const Real seconds = (static_cast<Real>(kStamp_ns) + static_cast<Real>(time_ns)) * 1e-9L;
  const ExactPose sensor = moved(moving.sensor, seconds);
  const ExactPose rest = {.rotation = moving.world_from_rest.linear().cast<Real>(),
                          .shift = moving.world_from_rest.translation().cast<Real>()};
  return {.shapes = {place_shape(shapes[0], moving.target_scale,
                                 relative_to_sensor(sensor, moved(moving.target, seconds))),
                     place_shape(shapes[2], moving.rest_scale, relative_to_sensor(sensor, rest))},
          .edge_tolerance_m = kEdgeTolerance_m};
}

}  // namespace

VerifyResult moving_sensor_and_target(const VerifySubject& subject,
                                      const std::vector<Shape>& shapes) {
  const MovingScene moving = make_moving_scene();
  Scene scene;
  add_shape(scene, shapes[0].mesh, moving.target_scale, moving.target.pose);
  add_shape(scene, shapes[2].mesh, moving.rest_scale, moving.world_from_rest);
  const Motion motion = {
      .world_from_sensor = moving.sensor,
      .world_from_instance = {moving.target, ConstantPose{moving.world_from_rest}}};
  Beams beams = random_probes(90051, 0.4, 0.2);
  for (std::uint32_t i = 0; i < beams.cols; ++i) beams.times_ns.push_back(i * kStep_ns);
  const std::vector<Pose> poses = {pose_at(moving.target, kStamp_ns), moving.world_from_rest};
  const std::unique_ptr<Renderer> renderer = subject.make(scene);
  MovingCastWorkspace memory;
  Hits hits;
  cast_moving({*renderer, scene, motion, kStamp_ns},
              {.beams = beams,
               .world_from_sensor = pose_at(moving.sensor, kStamp_ns),
               .world_from_instance = poses,
               .hit_columns = {.normal = true}},
              memory, hits);
  VerifyResult result;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    compare_beam(scene_at(moving, shapes, beams.times_ns[i]), beams.origins_m[i].cast<Real>(),
                 beams.directions[i].cast<Real>(),
                 {.instance = hits.instance[i],
                  .primitive = hits.primitive[i],
                  .range_m = hits.range_m[i],
                  .normal = hits.normal[i].cast<Real>()},
                 result);
  }
  return result;
}

}  // namespace glidar
