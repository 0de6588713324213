// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/moving_case.hpp>

#include <glidar/simulate/moving_cast.hpp>
#include <glidar/verify/comparison.hpp>
#include <glidar/verify/probes.hpp>

#include <cmath>

namespace glidar {
namespace {

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

/// Where sensor and target are at a beam's firing time.
struct Places {
  ExactPose sensor;
  ExactPose target;
  ExactPose rest;
};

Places places_at(const MovingScene& moving, std::uint32_t time_ns) {
  const Real seconds = (static_cast<Real>(kStamp_ns) + static_cast<Real>(time_ns)) * 1e-9L;
  return {.sensor = moved(moving.sensor, seconds),
          .target = moved(moving.target, seconds),
          .rest = {.rotation = moving.world_from_rest.linear().cast<Real>(),
                   .shift = moving.world_from_rest.translation().cast<Real>()}};
}

/// The shapes relative to the sensor at a beam's firing time.
ExactScene scene_at(const MovingScene& moving, const std::vector<Shape>& shapes,
                    const Places& places) {
  return {.shapes = {place_shape(shapes[0], moving.target_scale,
                                 relative_to_sensor(places.sensor, places.target)),
                     place_shape(shapes[2], moving.rest_scale,
                                 relative_to_sensor(places.sensor, places.rest))},
          .edge_tolerance_m = kEdgeTolerance_m};
}

/// The scene and motion of a moving sensor and target.
struct MovingStage {
  MovingScene moving = make_moving_scene();
  Scene scene;
  Motion motion;

  explicit MovingStage(const std::vector<Shape>& shapes) {
    add_shape(scene, shapes[0].mesh, moving.target_scale, moving.target.pose);
    add_shape(scene, shapes[2].mesh, moving.rest_scale, moving.world_from_rest);
    motion = {.world_from_sensor = moving.sensor,
              .world_from_instance = {moving.target, ConstantPose{moving.world_from_rest}}};
  }
};

/// The velocity of a point that is fixed to a body on a screw motion, world axes.
RealVector velocity_of(const ConstantTwist& twist, const ExactPose& body, const RealVector& point) {
  const RealVector turning = body.rotation * twist.angular_rad_s.cast<Real>();
  return body.rotation * twist.linear_m_s.cast<Real>() + turning.cross(point - body.shift);
}

double pose_error(const PoseVector& found, const ExactPose& exact) {
  const Eigen::Quaterniond attitude(found[3], found[4], found[5], found[6]);
  const RealMatrix turned = attitude.toRotationMatrix().cast<Real>() - exact.rotation;
  return static_cast<double>((found.head<3>().cast<Real>() - exact.shift).norm() + turned.norm());
}

/// The beams of the cast, as a sensor that measures radial velocities.
Sensor moving_sensor() {
  const Beams beams = random_probes(90051, 0.4, 0.2);
  RayTable table;
  table.rows = 1;
  table.cols = beams.cols;
  table.directions = beams.directions;
  table.origins_m = beams.origins_m;
  for (std::uint32_t i = 0; i < beams.cols; ++i) table.times_ns.push_back(i * double{kStep_ns});
  constexpr double kFrame_ns = 1.1e8;
  table.period_ns = kFrame_ns;
  Sensor sensor;
  sensor.optics = table;
  sensor.rate_hz = 1e9 / kFrame_ns;
  sensor.limits.along = Limits::Along::range;
  sensor.doppler = Doppler{};
  return sensor;
}

/// Compares what the frame states of a beam's motion.
void compare_motion(const MovingStage& stage, const Frame& frame, const Beams& beams, std::size_t i,
                    VerifyResult& result) {
  constexpr double kBound = 1e-12;  // m, rad and m/s: some hundred roundings of double
  const Places now = places_at(stage.moving, beams.times_ns[i]);
  const Places start = places_at(stage.moving, 0);
  const RealVector direction = beams.directions[i].cast<Real>();
  const RealVector origin = beams.origins_m[i].cast<Real>();
  const RealMatrix back = start.sensor.rotation.transpose();
  const RealVector moved_origin =
      back * (now.sensor.rotation * origin + now.sensor.shift - start.sensor.shift);
  const auto error = [](const RealVector& exact, const Eigen::Vector3d& found) {
    return static_cast<double>((found.cast<Real>() - exact).norm());
  };
  result.check(error(back * (now.sensor.rotation * direction), frame.deskewed.directions[i]),
               kBound);
  result.check(error(moved_origin, frame.deskewed.origins_m[i]), kBound);
  result.check(pose_error(frame.beam_poses.world_from_sensor[i], now.sensor), kBound);
  if (frame.ground_truth.instance[i] == kInvalidId) return;
  const bool is_target = frame.ground_truth.instance[i] == 0;
  const ExactPose& body = is_target ? now.target : now.rest;
  result.check(pose_error(frame.beam_poses.world_from_object[i], body), kBound);
  const RealVector from = now.sensor.rotation * origin + now.sensor.shift;
  const RealVector along = now.sensor.rotation * direction;
  const RealVector point = from + static_cast<Real>(frame.ground_truth.range_m[i]) * along;
  RealVector velocity = -velocity_of(stage.moving.sensor, now.sensor, from);
  if (is_target) velocity += velocity_of(stage.moving.target, now.target, point);
  const auto radial_m_s = static_cast<double>(velocity.dot(along));
  result.check(frame.true_radial_velocity_m_s[i] - radial_m_s, kBound);
  result.check(frame.radial_velocity_m_s[i] - radial_m_s, kBound);
  result.check(frame.range_m[i] - frame.ground_truth.range_m[i], kBound);
}

}  // namespace

VerifyResult moving_sensor_and_target(const VerifySubject& subject,
                                      const std::vector<Shape>& shapes) {
  const MovingStage stage(shapes);
  Beams beams = random_probes(90051, 0.4, 0.2);
  for (std::uint32_t i = 0; i < beams.cols; ++i) beams.times_ns.push_back(i * kStep_ns);
  const std::vector<Pose> poses = {pose_at(stage.moving.target, kStamp_ns),
                                   stage.moving.world_from_rest};
  const std::unique_ptr<Renderer> renderer = subject.make(stage.scene);
  MovingCastWorkspace memory;
  Hits hits;
  cast_moving({*renderer, stage.scene, stage.motion, kStamp_ns},
              {.beams = beams,
               .world_from_sensor = pose_at(stage.moving.sensor, kStamp_ns),
               .world_from_instance = poses,
               .hit_columns = {.normal = true}},
              memory, hits);
  VerifyResult result;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    compare_beam(scene_at(stage.moving, shapes, places_at(stage.moving, beams.times_ns[i])),
                 beams.origins_m[i].cast<Real>(), beams.directions[i].cast<Real>(),
                 {.instance = hits.instance[i],
                  .primitive = hits.primitive[i],
                  .range_m = hits.range_m[i],
                  .normal = hits.normal[i].cast<Real>()},
                 result);
  }
  return result;
}

VerifyResult measured_motion(const VerifySubject& subject, const std::vector<Shape>& shapes) {
  const MovingStage stage(shapes);
  const std::unique_ptr<Renderer> renderer = subject.make(stage.scene);
  Simulator simulator(stage.scene, moving_sensor(), *renderer);
  Frame frame;
  frame.stamp_ns = kStamp_ns;
  subject.measure(simulator, stage.motion, frame);
  const std::shared_ptr<const Beams> beams = simulator.beams();
  VerifyResult result;
  for (std::size_t i = 0; i < beams->size(); ++i) {
    compare_beam(scene_at(stage.moving, shapes, places_at(stage.moving, beams->times_ns[i])),
                 beams->origins_m[i].cast<Real>(), beams->directions[i].cast<Real>(),
                 {.instance = frame.ground_truth.instance[i],
                  .primitive = frame.ground_truth.primitive[i],
                  .range_m = frame.ground_truth.range_m[i],
                  .normal = frame.ground_truth.normal[i].cast<Real>()},
                 result);
    compare_motion(stage, frame, *beams, i, result);
  }
  return result;
}

}  // namespace glidar
