// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/cases.hpp>

#include <glidar/math/portable.hpp>
#include <glidar/math/random.hpp>
#include <glidar/sensor/optics/pinhole.hpp>
#include <glidar/simulate/moving_cast.hpp>
#include <glidar/verify/comparison.hpp>
#include <glidar/verify/shapes.hpp>
#include <glidar/verify/verify.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace glidar {

std::array<double, 4> probe_uniforms(std::uint32_t number, std::uint32_t index) {
  const RandomWords words =
      random_words({.seed = 1, .frame = number, .beam = index, .purpose = Purpose::verification});
  return {uniform(words[0]), uniform(words[1]), uniform(words[2]), uniform(words[3])};
}

Eigen::Quaterniond random_rotation(const std::array<double, 4>& u) {
  const double a = std::sqrt(1.0 - u[0]);
  const double b = std::sqrt(u[0]);
  const double s = 2.0 * std::numbers::pi * u[1];
  const double t = 2.0 * std::numbers::pi * u[2];
  return Eigen::Quaterniond(b * portable_cos(t), a * portable_sin(s), a * portable_cos(s),
                            b * portable_sin(t))
      .normalized();
}

Eigen::Vector3d random_direction(double u0, double u1, double half_angle_rad) {
  const double z = 1.0 - u0 * (1.0 - portable_cos(half_angle_rad));
  const double r = std::sqrt(1.0 - z * z);
  const double angle = 2.0 * std::numbers::pi * u1;
  return Eigen::Vector3d(r * portable_cos(angle), r * portable_sin(angle), z).normalized();
}

Beams camera_probes(double half_view_rad) {
  constexpr std::uint32_t kImageSide = 64;
  return make_beams(pinhole_from_fov(kImageSide, kImageSide, 2.0 * half_view_rad));
}

Beams scanner_probes() {
  constexpr std::uint32_t kRows = 32;
  constexpr std::uint32_t kColumns = 1024;
  constexpr double kStep_rad = 2.0 * std::numbers::pi / kColumns;
  Beams beams;
  beams.rows = kRows;
  beams.cols = kColumns;
  beams.frame_id = "verify";
  beams.boresight = Eigen::Vector3d::UnitX();
  for (std::uint32_t row = 0; row < kRows; ++row) {
    const double part = (row + 0.5) / kRows - 0.5;
    const double elevation_rad = 0.5 * part + 1.2 * part * part * part;
    for (std::uint32_t col = 0; col < kColumns; ++col) {
      const double azimuth_rad = kStep_rad * (col + 0.25 * (row % 4));
      const Eigen::Vector3d direction(portable_cos(azimuth_rad) * portable_cos(elevation_rad),
                                      portable_sin(azimuth_rad) * portable_cos(elevation_rad),
                                      portable_sin(elevation_rad));
      beams.directions.push_back(direction.normalized());
    }
  }
  return beams;
}

Beams unstructured_probes(std::vector<Eigen::Vector3d> directions,
                          std::vector<Eigen::Vector3d> origins_m) {
  Beams beams;
  beams.rows = 1;
  beams.cols = static_cast<std::uint32_t>(directions.size());
  beams.frame_id = "verify";
  beams.directions = std::move(directions);
  beams.origins_m = std::move(origins_m);
  return beams;
}

Beams random_probes(std::uint32_t number, double half_view_rad, double spread_m) {
  constexpr std::uint32_t kRandomRays = 4096;
  std::vector<Eigen::Vector3d> directions;
  std::vector<Eigen::Vector3d> origins_m;
  for (std::uint32_t i = 0; i < kRandomRays; ++i) {
    const std::array<double, 4> u = probe_uniforms(number, 1 + i);
    directions.push_back(random_direction(u[0], u[1], half_view_rad));
    origins_m.emplace_back(spread_m * (u[2] - 0.5), spread_m * (u[3] - 0.5), 0.0);
  }
  return unstructured_probes(std::move(directions), std::move(origins_m));
}

namespace {

constexpr Real kMinCosine = 0.01L;  // of faces that are clearly front or back faces

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The vertices, edges and faces of a placed shape, as seen from the sensor.
class ShapeView {
 public:
  explicit ShapeView(const PlacedShape& placed) : placed_(placed) {
    const std::vector<Triangle>& triangles = placed.shape.mesh.triangles;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const RealVector a = vertex(triangles[t][0]);
      const RealVector normal =
          (vertex(triangles[t][1]) - a).cross(vertex(triangles[t][2]) - a).normalized();
      cosine_.push_back(-normal.dot(a.normalized()));
      normal_.push_back(normal);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = triangles[t][k];
        edges_[std::minmax(from, triangles[t][(k + 1) % 3])].push_back(t);
        around_[from].push_back(t);
      }
    }
  }

  [[nodiscard]] RealVector vertex(std::uint32_t i) const {
    return exact_vertex(placed_.shape.mesh, i, placed_.scale, placed_.pose);
  }
  [[nodiscard]] bool are_visible(const std::vector<std::uint32_t>& triangles) const {
    return std::all_of(triangles.begin(), triangles.end(),
                       [&](std::uint32_t t) { return cosine_[t] > kMinCosine; });
  }
  /// True if the edge of two triangles is part of the silhouette.
  [[nodiscard]] bool is_outline(const std::vector<std::uint32_t>& triangles) const {
    const Real a = cosine_[triangles[0]];
    const Real b = cosine_[triangles[1]];
    return std::max(a, b) > kMinCosine && std::min(a, b) < -kMinCosine;
  }
  [[nodiscard]] RealVector outwards(const std::vector<std::uint32_t>& triangles) const {
    return (normal_[triangles[0]] + normal_[triangles[1]]).normalized();
  }
  [[nodiscard]] const std::map<Edge, std::vector<std::uint32_t>>& edges() const { return edges_; }
  [[nodiscard]] const std::map<std::uint32_t, std::vector<std::uint32_t>>& triangles_at_vertices()
      const {
    return around_;
  }
  [[nodiscard]] RealVector centre() const { return placed_.pose.shift; }

 private:
  const PlacedShape& placed_;
  std::vector<Real> cosine_;  ///< per triangle, towards the sensor
  std::vector<RealVector> normal_;
  std::map<Edge, std::vector<std::uint32_t>> edges_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> around_;  ///< per vertex
};

Eigen::Vector3d direction_to(const AimTarget& at, const RealVector& point) {
  return (at.sensor_from_axes * point.normalized().cast<double>()).normalized();
}

}  // namespace

Beams beams_at_vertices_and_edges(const AimTarget& at) {
  constexpr Real kScale = 1.3L;  // of a vertex, relative to the shape's centre
  const ShapeView view(at.placed);
  std::vector<Eigen::Vector3d> directions;
  for (const auto& [vertex, triangles] : view.triangles_at_vertices()) {
    const RealVector point = view.vertex(vertex);
    if (view.are_visible(triangles)) directions.push_back(direction_to(at, point));
    directions.push_back(direction_to(at, view.centre() + kScale * (point - view.centre())));
  }
  std::uint32_t index = 0;
  for (const auto& [edge, triangles] : view.edges()) {
    if (!view.are_visible(triangles)) continue;
    const std::array<double, 4> u = probe_uniforms(at.number, index++);
    for (const double part : {0.5, u[0], u[1], u[2], u[3]}) {
      const RealVector from = view.vertex(edge.first);
      directions.push_back(
          direction_to(at, from + static_cast<Real>(part) * (view.vertex(edge.second) - from)));
    }
  }
  return unstructured_probes(std::move(directions));
}

Beams beams_beside_outline(const AimTarget& at) {
  const ShapeView view(at.placed);
  std::vector<Eigen::Vector3d> directions;
  std::uint32_t index = 0;
  for (const auto& [edge, triangles] : view.edges()) {
    if (!view.is_outline(triangles)) continue;
    for (int i = 0; i < 16; ++i) {
      const std::array<double, 4> u = probe_uniforms(at.number, index++);
      const RealVector from = view.vertex(edge.first);
      const RealVector point = from + static_cast<Real>(u[0]) * (view.vertex(edge.second) - from);
      const double beside = (u[1] < 0.5 ? -1.0 : 1.0) * portable_pow(10.0, -9.0 + 3.0 * u[2]);
      directions.push_back(direction_to(
          at, point + static_cast<Real>(beside * at.placed.scale) * view.outwards(triangles)));
    }
  }
  return unstructured_probes(std::move(directions));
}

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

/// A shape on a screw motion, or at rest.
struct Body {
  const Shape& shape;
  double scale;
  ConstantTwist motion;
  bool is_at_rest = false;

  [[nodiscard]] ExactPose pose_after(Real seconds) const {
    if (!is_at_rest) return moved(motion, seconds);
    return {.rotation = motion.pose.linear().cast<Real>(),
            .shift = motion.pose.translation().cast<Real>()};
  }
};

Real seconds_at(std::uint32_t beam_time_ns) {
  return (static_cast<Real>(kStamp_ns) + static_cast<Real>(beam_time_ns)) * 1e-9L;
}

/// A moving sensor and bodies, each an instance of a scene.
struct MovingStage {
  ConstantTwist sensor = {.pose = make_pose({0.5, -0.25, 0.0}, Eigen::Quaterniond::Identity()),
                          .angular_rad_s = {0.3, -0.2, 0.5},
                          .linear_m_s = {1.0, -0.5, 2.0}};
  std::vector<Body> bodies;
  Scene scene;
  Motion motion = {.world_from_sensor = sensor, .world_from_instance = {}};

  explicit MovingStage(std::vector<Body> all) : bodies(std::move(all)) {
    for (const Body& body : bodies) {
      add_shape(scene, body.shape.mesh, body.scale, body.motion.pose);
      if (body.is_at_rest) {
        motion.world_from_instance.emplace_back(ConstantPose{body.motion.pose});
      } else {
        motion.world_from_instance.emplace_back(body.motion);
      }
    }
  }

  /// The shapes relative to the sensor at a beam's firing time.
  [[nodiscard]] ExactScene scene_at(std::uint32_t time_ns) const {
    const ExactPose from = moved(sensor, seconds_at(time_ns));
    ExactScene exact{.shapes = {}, .edge_tolerance_m = kEdgeTolerance_m};
    for (const Body& body : bodies) {
      exact.shapes.push_back(place_shape(
          body.shape, body.scale, relative_to_sensor(from, body.pose_after(seconds_at(time_ns)))));
    }
    return exact;
  }
};

/// A target that moves, and a body at rest.
MovingStage target_and_rest(const std::vector<Shape>& shapes) {
  constexpr std::uint32_t kNumber = 90050;
  return MovingStage(
      {{.shape = shapes[0],
        .scale = 2.0,
        .motion = {.pose = make_pose({0.0, 0.5, 12.0}, random_rotation(probe_uniforms(kNumber, 0))),
                   .angular_rad_s = {-0.4, 0.7, 0.2},
                   .linear_m_s = {3.0, -1.0, 0.5}}},
       {.shape = shapes[2],
        .scale = 1.5,
        .motion = {.pose = make_pose({3.0, 1.5, 9.0}, random_rotation(probe_uniforms(kNumber, 1)))},
        .is_at_rest = true}});
}

/// Boxes and tetrahedra of 0.3 to 1.3 m that occlude each other, 4 to 40 m ahead. Of three, two
/// drive at up to 10 m/s and turn.
MovingStage traffic(const std::vector<Shape>& shapes) {
  constexpr std::uint32_t kNumber = 90052;
  constexpr std::uint32_t kBodies = 96;
  std::vector<Body> bodies;
  for (std::uint32_t i = 0; i < kBodies; ++i) {
    const auto u = probe_uniforms(kNumber, 3 * i);
    const auto v = probe_uniforms(kNumber, 3 * i + 1);
    const Eigen::Vector3d place = (4.0 + 36.0 * u[2]) * random_direction(u[0], u[1], 0.5);
    bodies.push_back(
        {.shape = shapes[i % 2 == 0 ? 0 : 2],
         .scale = 0.3 + u[3],
         .motion = {.pose = make_pose(place, random_rotation(probe_uniforms(kNumber, 3 * i + 2))),
                    .angular_rad_s = {v[0] - 0.5, 2.0 * v[1], v[2]},
                    .linear_m_s = 10.0 * random_direction(v[3], v[0], 3.0)},
         .is_at_rest = i % 3 == 2});
  }
  return MovingStage(std::move(bodies));
}

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
  const ExactPose sensor = moved(stage.sensor, seconds_at(beams.times_ns[i]));
  const ExactPose start = moved(stage.sensor, seconds_at(0));
  const RealVector direction = beams.directions[i].cast<Real>();
  const RealVector origin = beams.origins_m[i].cast<Real>();
  const RealMatrix back = start.rotation.transpose();
  const RealVector moved_origin = back * (sensor.rotation * origin + sensor.shift - start.shift);
  const auto error = [](const RealVector& exact, const Eigen::Vector3d& found) {
    return static_cast<double>((found.cast<Real>() - exact).norm());
  };
  result.check(error(back * (sensor.rotation * direction), frame.deskewed.directions[i]), kBound);
  result.check(error(moved_origin, frame.deskewed.origins_m[i]), kBound);
  result.check(pose_error(frame.beam_poses.world_from_sensor[i], sensor), kBound);
  if (frame.ground_truth.instance[i] == kInvalidId) return;
  const Body& body = stage.bodies[frame.ground_truth.instance[i]];
  const ExactPose place = body.pose_after(seconds_at(beams.times_ns[i]));
  result.check(pose_error(frame.beam_poses.world_from_object[i], place), kBound);
  const RealVector from = sensor.rotation * origin + sensor.shift;
  const RealVector along = sensor.rotation * direction;
  const RealVector point = from + static_cast<Real>(frame.ground_truth.range_m[i]) * along;
  RealVector velocity = -velocity_of(stage.sensor, sensor, from);
  if (!body.is_at_rest) velocity += velocity_of(body.motion, place, point);
  const auto radial_m_s = static_cast<double>(velocity.dot(along));
  result.check(frame.true_radial_velocity_m_s[i] - radial_m_s, kBound);
  result.check(frame.radial_velocity_m_s[i] - radial_m_s, kBound);
  result.check(frame.range_m[i] - frame.ground_truth.range_m[i], kBound);
}

/// Casts with a beam every kStep_ns and compares each with the scene of its firing time.
VerifyResult cast_stage(const VerifySubject& subject, const MovingStage& stage, Beams beams) {
  for (std::uint32_t i = 0; i < beams.cols; ++i) beams.times_ns.push_back(i * kStep_ns);
  std::vector<Pose> poses;
  for (const Body& body : stage.bodies) {
    poses.push_back(body.is_at_rest ? body.motion.pose : pose_at(body.motion, kStamp_ns));
  }
  const std::unique_ptr<Renderer> renderer = subject.make(stage.scene);
  MovingCastWorkspace memory;
  Hits hits;
  cast_moving({*renderer, stage.scene, stage.motion, kStamp_ns},
              {.beams = beams,
               .world_from_sensor = pose_at(stage.sensor, kStamp_ns),
               .world_from_instance = poses,
               .hit_columns = {.normal = true}},
              memory, hits);
  VerifyResult result;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    compare_beam(stage.scene_at(beams.times_ns[i]), beams.origins_m[i].cast<Real>(),
                 beams.directions[i].cast<Real>(),
                 {.instance = hits.instance[i],
                  .primitive = hits.primitive[i],
                  .range_m = hits.range_m[i],
                  .normal = hits.normal[i].cast<Real>()},
                 result);
  }
  return result;
}

}  // namespace

VerifyResult moving_sensor_and_target(const VerifySubject& subject,
                                      const std::vector<Shape>& shapes) {
  return cast_stage(subject, target_and_rest(shapes), random_probes(90051, 0.4, 0.2));
}

VerifyResult sensor_in_traffic(const VerifySubject& subject, const std::vector<Shape>& shapes) {
  return cast_stage(subject, traffic(shapes), random_probes(90053, 0.6, 0.2));
}

VerifyResult measured_motion(const VerifySubject& subject, const std::vector<Shape>& shapes) {
  const MovingStage stage = target_and_rest(shapes);
  const std::unique_ptr<Renderer> renderer = subject.make(stage.scene);
  Simulator simulator(stage.scene, moving_sensor(), *renderer);
  Frame frame;
  frame.stamp_ns = kStamp_ns;
  subject.measure(simulator, stage.motion, frame);
  const std::shared_ptr<const Beams> beams = simulator.beams();
  VerifyResult result;
  for (std::size_t i = 0; i < beams->size(); ++i) {
    compare_beam(stage.scene_at(beams->times_ns[i]), beams->origins_m[i].cast<Real>(),
                 beams->directions[i].cast<Real>(),
                 {.instance = frame.ground_truth.instance[i],
                  .primitive = frame.ground_truth.primitive[i],
                  .range_m = frame.ground_truth.range_m[i],
                  .normal = frame.ground_truth.normal[i].cast<Real>()},
                 result);
    compare_motion(stage, frame, *beams, i, result);
  }
  return result;
}

namespace {

constexpr double kViewOverShape = 1.15;  // field of view over the angle of the bounding sphere

/// Half the field of view: that of the sphere around the shape, and a margin.
double half_view_rad(const VerifyCase& c) {
  return kViewOverShape * portable_asin(c.radius_m / (c.distance_m + c.radius_m));
}

/// A scene of one shape, and the sensor's pose.
struct Stage {
  Scene scene;
  Pose world_from_sensor = Pose::Identity();
};

Stage make_stage(const VerifyCase& c, const Shape& shape) {
  const Eigen::Vector3d position = c.offset_m * Eigen::Vector3d(0.6, -0.64, 0.48);
  const Eigen::Quaterniond attitude = random_rotation(probe_uniforms(c.number, 0));
  constexpr std::uint32_t kViewIndex = 4097;  // after those of random_probes()
  const Eigen::Quaterniond view = random_rotation(probe_uniforms(c.number, kViewIndex));
  Stage stage;
  Mesh mesh = shape.mesh;
  Pose world_from_object = make_pose(position, attitude);
  if (c.offset_in_mesh) {
    mesh.origin_m = position / c.radius_m;
    world_from_object.translation() =
        position - world_from_object.linear() * (c.radius_m * mesh.origin_m);
  }
  add_shape(stage.scene, std::move(mesh), c.radius_m, world_from_object);
  const Eigen::Vector3d back = view * Eigen::Vector3d(0.0, 0.0, -(c.distance_m + c.radius_m));
  stage.world_from_sensor = make_pose(position + back, view);
  return stage;
}

}  // namespace

const std::vector<double>& verify_distances() {
  static const std::vector<double> kDistances = {0.1, 1.0, 10.0, 100.0, 1000.0, 10000.0};
  return kDistances;
}

std::vector<VerifyCase> make_cases(std::size_t shape, double distance_m) {
  constexpr double kScaledRadius = 0.2;  // times the distance: 20 degrees wide
  constexpr double kFixedRadius_m = 0.5;
  struct Offset {
    double offset_m;
    bool in_mesh;
  };
  constexpr std::array<Offset, 4> kOffsets = {
      {{0.0, false}, {1e3, false}, {1e6, false}, {1e6, true}}};
  constexpr std::uint32_t kNumberStep = 1000;  // so that no two cases share random numbers
  std::vector<VerifyCase> cases;
  auto number =
      static_cast<std::uint32_t>(shape) * kNumberStep +
      static_cast<std::uint32_t>(10.0 * (5.0 + portable_log(distance_m) * std::numbers::log10e));
  for (const double radius_m : {kScaledRadius * distance_m, kFixedRadius_m}) {
    for (const Offset& offset : kOffsets) {
      cases.push_back({.shape = shape,
                       .distance_m = distance_m,
                       .radius_m = radius_m,
                       .offset_m = offset.offset_m,
                       .offset_in_mesh = offset.in_mesh,
                       .number = number++});
    }
  }
  return cases;
}

VerifyResult run_case(const VerifyCase& c, const Shape& shape, const VerifySubject& subject) {
  const Stage stage = make_stage(c, shape);
  const std::unique_ptr<Renderer> renderer = subject.make(stage.scene);
  const Instance& instance = stage.scene.instances[0];
  const Shape placed{.name = shape.name,
                     .mesh = stage.scene.meshes[0],
                     .faces = shape.faces,
                     .solid = shape.solid};
  const ExactScene exact{
      .shapes = {place_shape(
          placed, instance.scale,
          relative_pose(instance.world_from_object, stage.world_from_sensor.translation()))},
      .edge_tolerance_m = kEdgeTolerance * c.radius_m};
  std::vector<Beams> casts = {camera_probes(half_view_rad(c))};
  if (subject.casts == BeamKind::any) {
    const double spread_m = 0.05 * std::min(c.radius_m, c.distance_m);
    casts.push_back(random_probes(c.number, half_view_rad(c), spread_m));
  }
  VerifyResult result;
  Hits hits;
  for (const Beams& beams : casts) {
    renderer->cast({.beams = beams,
                    .world_from_sensor = stage.world_from_sensor,
                    .world_from_instance = {},
                    .hit_columns = kGeometricColumns,
                    .cull_back_faces = false},
                   hits);
    result.add(compare_cast(exact, stage.world_from_sensor, beams, hits, renderer->thread_pool()));
  }
  return result;
}

}  // namespace glidar
