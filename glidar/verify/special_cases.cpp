// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/special_cases.hpp>

#include <glidar/math/portable.hpp>
#include <glidar/verify/aimed_probes.hpp>
#include <glidar/verify/comparison.hpp>
#include <glidar/verify/large_cases.hpp>
#include <glidar/verify/measurement_cases.hpp>
#include <glidar/verify/moving_case.hpp>
#include <glidar/verify/probes.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

/// Relative to distance and size: a few hundred roundings of double. Rays nearer to a silhouette
/// are not compared.
constexpr double kExactTolerance = 1e-13;

/// Height of the sensor above a planet.
constexpr double kHeight_m = 1.5;

/// A shape in the world.
struct ShapeInstance {
  const Shape& shape;
  double scale;
  Pose world_from_object;
};

Scene make_scene(const std::vector<ShapeInstance>& instances) {
  Scene scene;
  for (const ShapeInstance& instance : instances) {
    add_shape(scene, instance.shape.mesh, instance.scale, instance.world_from_object);
  }
  return scene;
}

ExactScene exact_scene(const std::vector<ShapeInstance>& instances,
                       const Eigen::Vector3d& viewpoint) {
  ExactScene exact;
  for (const ShapeInstance& instance : instances) {
    exact.shapes.push_back(place_shape(instance.shape, instance.scale,
                                       relative_pose(instance.world_from_object, viewpoint)));
  }
  return exact;
}

VerifyResult cast_and_compare(Renderer& renderer, const ExactScene& exact,
                              const Pose& world_from_sensor, const Beams& beams) {
  Hits hits;
  renderer.cast(
      {.beams = beams, .world_from_sensor = world_from_sensor, .hit_columns = kGeometricColumns},
      hits);
  return compare_cast(exact, world_from_sensor, beams, hits, renderer.thread_pool());
}

/// Casts the beams of a camera and, if the renderer supports them, random beams.
VerifyResult cast_view(const VerifySubject& subject, Renderer& renderer, const ExactScene& exact,
                       const Pose& world_from_sensor, double half_view_rad) {
  constexpr std::uint32_t kNumber = 90001;
  constexpr double kSpread_m = 0.1;
  VerifyResult result =
      cast_and_compare(renderer, exact, world_from_sensor, camera_probes(half_view_rad));
  if (subject.casts == BeamKind::any) {
    result.add(cast_and_compare(renderer, exact, world_from_sensor,
                                random_probes(kNumber, half_view_rad, kSpread_m)));
  }
  return result;
}

/// Two of each shape in a cube of 40 m, and one shape 10 m from the sensor.
std::vector<ShapeInstance> cloud_of_shapes(const std::vector<Shape>& shapes,
                                           const Pose& world_from_sensor, double distance_m) {
  constexpr std::uint32_t kNumber = 90010;
  constexpr double kHalfSize_m = 20.0;
  std::vector<ShapeInstance> instances;
  for (std::uint32_t i = 0; i < 2 * shapes.size(); ++i) {
    const std::array<double, 4> u = probe_uniforms(kNumber, 2 * i);
    const Eigen::Vector3d in_sensor =
        kHalfSize_m * (2.0 * Eigen::Vector3d(u[0], u[1], u[2]) - Eigen::Vector3d::Ones()) +
        Eigen::Vector3d(0.0, 0.0, distance_m);
    const Eigen::Quaterniond attitude = random_rotation(probe_uniforms(kNumber, 2 * i + 1));
    instances.push_back({shapes[i % shapes.size()], 2.0 + 4.0 * u[3],
                         make_pose(world_from_sensor * in_sensor, attitude)});
  }
  const Eigen::Vector3d near = world_from_sensor * Eigen::Vector3d(3.0, 0.0, 10.0);
  instances.push_back(
      {shapes[0], 1.5, make_pose(near, random_rotation(probe_uniforms(kNumber, 1000)))});
  return instances;
}

VerifyResult several_instances(const VerifySubject& subject, const std::vector<Shape>& shapes,
                               double distance_m) {
  constexpr double kHalfView_m = 25.0;
  constexpr double kWide_rad = 0.5;
  const Pose world_from_sensor =
      make_pose({12.0, -7.0, 3.0}, random_rotation(probe_uniforms(90011, 0)));
  const std::vector<ShapeInstance> instances =
      cloud_of_shapes(shapes, world_from_sensor, distance_m);
  const Scene scene = make_scene(instances);
  const std::unique_ptr<Renderer> renderer = subject.make(scene);
  ExactScene exact = exact_scene(instances, world_from_sensor.translation());
  exact.edge_tolerance_m = kExactTolerance * distance_m;
  VerifyResult result = cast_view(subject, *renderer, exact, world_from_sensor,
                                  portable_atan(kHalfView_m / distance_m));
  result.add(cast_view(subject, *renderer, exact, world_from_sensor, kWide_rad));
  if (subject.casts != BeamKind::any) return result;
  // Single precision is wrong for about one beam in a thousand here, and for fewer at short range:
  // cast enough beams that several are wrong on any processor.
  constexpr double kBeamsTimesDistance = 1.28e6;
  constexpr std::uint32_t kNumber = 90100;
  const auto casts = static_cast<std::uint32_t>(kBeamsTimesDistance / distance_m);
  for (std::uint32_t i = 0; i < casts; ++i) {
    result.add(
        cast_and_compare(*renderer, exact, world_from_sensor,
                         random_probes(kNumber + i, portable_atan(kHalfView_m / distance_m), 0.1)));
  }
  return result;
}

/// Bodies all around a scanner; some beams pass between them.
VerifyResult scanner_among_bodies(const VerifySubject& subject, const std::vector<Shape>& shapes) {
  constexpr std::uint32_t kNumber = 90060;
  constexpr std::uint32_t kBodies = 40;
  const Pose world_from_sensor =
      make_pose({-3.0, 8.0, 1.0}, random_rotation(probe_uniforms(kNumber, 0)));
  std::vector<ShapeInstance> instances;
  for (std::uint32_t i = 0; i < kBodies; ++i) {
    const std::array<double, 4> u = probe_uniforms(kNumber, 2 * i + 1);
    const double distance_m = 5.0 + 5.0 * i;
    const Eigen::Vector3d direction = random_direction(u[0], u[1], std::numbers::pi);
    instances.push_back({shapes[i % shapes.size()], 0.4 * distance_m * (0.2 + u[2]),
                         make_pose(world_from_sensor * (distance_m * direction),
                                   random_rotation(probe_uniforms(kNumber, 2 * i + 2)))});
  }
  const Scene scene = make_scene(instances);
  ExactScene exact = exact_scene(instances, world_from_sensor.translation());
  exact.edge_tolerance_m = kExactTolerance * 5.0 * kBodies;
  return cast_and_compare(*subject.make(scene), exact, world_from_sensor, scanner_probes());
}

VerifyResult above_a_planet(const VerifySubject& subject, const Shape& shape, double height_m) {
  constexpr double kRadius_m = 6.371e6;
  constexpr double kHalfView_rad = 0.8;
  constexpr std::size_t kFace = 17;
  const Pose world_from_object =
      make_pose(Eigen::Vector3d::Zero(), random_rotation(probe_uniforms(90020, 0)));
  std::array<Eigen::Vector3d, 3> corner;
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k] = world_from_object *
                (kRadius_m * shape.mesh.positions_m[shape.faces[kFace][k]].cast<double>());
  }
  const Eigen::Vector3d up = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
  const Eigen::Vector3d eye = (corner[0] + corner[1] + corner[2]) / 3.0 + height_m * up;
  const Eigen::Vector3d ahead = (corner[0] - corner[1]).normalized() - 0.5 * up;
  const Pose world_from_sensor = look_at(eye, eye + ahead, up);
  const std::vector<ShapeInstance> instances = {{shape, kRadius_m, world_from_object}};
  const Scene scene = make_scene(instances);
  ExactScene exact = exact_scene(instances, eye);
  exact.edge_tolerance_m = kExactTolerance * kRadius_m;
  return cast_view(subject, *subject.make(scene), exact, world_from_sensor, kHalfView_rad);
}

/// With these poses and sizes the sensor is exactly on the vertices.
VerifyResult sensor_on_vertices(const VerifySubject& subject, const Shape& shape) {
  constexpr double kScale = 2.0;
  constexpr std::size_t kMaxVertices = 8;
  const std::vector<ShapeInstance> instances = {{shape, kScale, Pose::Identity()}};
  const Scene scene = make_scene(instances);
  const std::unique_ptr<Renderer> renderer = subject.make(scene);
  VerifyResult result;
  const std::size_t count = std::min(kMaxVertices, shape.mesh.positions_m.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d eye = kScale * shape.mesh.positions_m[i].cast<double>();
    const Pose into = look_at(eye, {0.01, 0.02, 0.03}, {0.1, 0.2, 1.0});
    ExactScene exact = exact_scene(instances, eye);
    exact.edge_tolerance_m = kExactTolerance * kScale;
    exact.is_from_inside = true;
    result.add(cast_and_compare(*renderer, exact, into, camera_probes(0.25 * std::numbers::pi)));
    result.add(cast_and_compare(*renderer, exact, into, camera_probes(0.45 * std::numbers::pi)));
    if (subject.casts != BeamKind::any) continue;
    Beams all_around = random_probes(90030, std::numbers::pi, 0.0);
    all_around.origins_m.clear();
    result.add(cast_and_compare(*renderer, exact, into, all_around));
  }
  return result;
}

/// A function that aims beams at a shape.
using AimFunction = Beams (*)(const AimTarget&);

VerifyResult cast_aimed_beams(const VerifySubject& subject, const Shape& shape, double distance_m,
                              AimFunction aim) {
  constexpr std::uint32_t kNumber = 90040;
  constexpr std::uint32_t kEyes = 24;
  const Pose world_from_object =
      make_pose({4.0, -1.0, 2.0}, random_rotation(probe_uniforms(kNumber, 0)));
  const std::vector<ShapeInstance> instances = {{shape, 1.5, world_from_object}};
  const Scene scene = make_scene(instances);
  const std::unique_ptr<Renderer> renderer = subject.make(scene);
  VerifyResult result;
  for (std::uint32_t i = 1; i <= kEyes; ++i) {
    const Eigen::Quaterniond view = random_rotation(probe_uniforms(kNumber, i));
    const Eigen::Vector3d eye =
        world_from_object.translation() - view * Eigen::Vector3d(0.0, 0.0, distance_m + 1.5);
    const Pose world_from_sensor = make_pose(eye, view);
    const ExactScene exact = exact_scene(instances, eye);
    const Beams beams = aim({.placed = exact.shapes[0],
                             .sensor_from_axes = world_from_sensor.linear().transpose(),
                             .number = kNumber + i});
    result.add(cast_and_compare(*renderer, exact, world_from_sensor, beams));
  }
  return result;
}

/// Beams that are aimed at vertices, edges and silhouettes.
void add_aimed_cases(const Shape& shape, std::vector<SpecialCase>& cases) {
  for (const double distance_m : {1.0, 1000.0}) {
    cases.push_back({"at vertices and edges", shape.name, distance_m, BeamKind::any,
                     [&shape, distance_m](const auto& s) {
                       return cast_aimed_beams(s, shape, distance_m, beams_at_vertices_and_edges);
                     }});
  }
  cases.push_back({"beside the outline", shape.name, 1.0, BeamKind::any, [&shape](const auto& s) {
                     return cast_aimed_beams(s, shape, 1.0, beams_beside_outline);
                   }});
}

}  // namespace

std::vector<SpecialCase> special_cases(const std::vector<Shape>& shapes) {
  std::vector<SpecialCase> cases;
  for (const double distance_m : {1e4, 1e5}) {
    cases.push_back(
        {"several instances", "all", distance_m, BeamKind::pinhole,
         [&, distance_m](const auto& s) { return several_instances(s, shapes, distance_m); }});
  }
  const Shape& sphere = shapes.back();
  cases.push_back({"above a planet", sphere.name, kHeight_m, BeamKind::pinhole,
                   [&](const auto& s) { return above_a_planet(s, sphere, kHeight_m); }});
  cases.push_back({"scanner among bodies", "all", 5.0, BeamKind::scanner,
                   [&](const auto& s) { return scanner_among_bodies(s, shapes); }});
  cases.push_back({"moving sensor and target", shapes.front().name, 10.0, BeamKind::any,
                   [&](const auto& s) { return moving_sensor_and_target(s, shapes); }});
  for (const Shape& shape : shapes) {
    if (!shape.solid) continue;
    cases.push_back({"sensor on a vertex", shape.name, 0.0, BeamKind::pinhole,
                     [&](const auto& s) { return sensor_on_vertices(s, shape); }});
  }
  for (const Shape& shape : shapes) {
    if (shape.solid) add_aimed_cases(shape, cases);
  }
  add_large_cases(shapes, cases);
  add_measurement_cases(shapes, cases);
  return cases;
}

}  // namespace glidar
