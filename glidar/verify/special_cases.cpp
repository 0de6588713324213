// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/cases.hpp>

#include <glidar/math/portable.hpp>
#include <glidar/verify/comparison.hpp>

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

// Large casts and scenes

constexpr double kSilhouette = 1e-13;  // relative to the distance; nearer beams are not compared

/// A scene and its exact description from a viewpoint.
struct LargeScene {
  Scene scene;
  ExactScene exact;
  Pose world_from_sensor;
};

void place(const Shape& shape, double scale, const Pose& world_from_object, LargeScene& large) {
  add_shape(large.scene, shape.mesh, scale, world_from_object);
  large.exact.shapes.push_back(place_shape(
      shape, scale, relative_pose(world_from_object, large.world_from_sensor.translation())));
}

VerifyResult cast_large(Renderer& renderer, const LargeScene& large, const Beams& beams,
                        std::size_t stride, bool cull_back_faces = false) {
  Hits hits;
  renderer.cast({.beams = beams,
                 .world_from_sensor = large.world_from_sensor,
                 .hit_columns = kGeometricColumns,
                 .cull_back_faces = cull_back_faces},
                hits);
  return compare_cast(large.exact, large.world_from_sensor, beams, hits, renderer.thread_pool(),
                      stride);
}

Beams wide_camera(std::uint32_t width, std::uint32_t height, double fov_rad) {
  return make_beams(pinhole_from_fov(width, height, fov_rad));
}

/// The rows of several scanner_probes(), each lower than the one before.
Beams tall_scanner(std::uint32_t copies) {
  const Beams one = scanner_probes();
  Beams beams = one;
  for (std::uint32_t copy = 1; copy < copies; ++copy) {
    const double down = 0.004 * copy;
    for (const Eigen::Vector3d& d : one.directions) {
      const double level = std::hypot(d.x(), d.y());
      const double elevation_rad = std::atan2(d.z(), level) - down;
      beams.directions.emplace_back(d.x() / level * std::cos(elevation_rad),
                                    d.y() / level * std::cos(elevation_rad),
                                    std::sin(elevation_rad));
    }
  }
  beams.rows *= copies;
  return beams;
}

Pose somewhere(std::uint32_t number) {
  return make_pose({7.0, -3.0, 11.0}, random_rotation(probe_uniforms(number, 0)));
}

/// Some of each shape around the sensor, most of them ahead.
LargeScene bodies_around(const std::vector<Shape>& shapes, std::uint32_t number) {
  LargeScene large{.scene = {}, .exact = {}, .world_from_sensor = somewhere(number)};
  large.exact.edge_tolerance_m = kSilhouette * 30.0;
  for (std::uint32_t i = 0; i < 4 * shapes.size(); ++i) {
    const std::array<double, 4> u = probe_uniforms(number, 2 * i + 1);
    const bool is_ahead = i % 4 != 0;
    const Eigen::Vector3d direction =
        random_direction(u[0], u[1], is_ahead ? 0.5 : std::numbers::pi);
    const double distance_m = 6.0 + 20.0 * u[2];
    place(shapes[i % shapes.size()], 0.05 * distance_m * (1.0 + u[3]),
          make_pose(large.world_from_sensor * (distance_m * direction),
                    random_rotation(probe_uniforms(number, 2 * i + 2))),
          large);
  }
  return large;
}

/// Renderers split large casts into tiles.
VerifyResult several_tiles(const VerifySubject& subject, const std::vector<Shape>& shapes) {
  constexpr std::uint32_t kNumber = 90200;
  constexpr std::size_t kStride = 3;
  const LargeScene large = bodies_around(shapes, kNumber);
  const std::unique_ptr<Renderer> renderer = subject.make(large.scene);
  VerifyResult result = cast_large(*renderer, large, wide_camera(480, 270, 0.7), kStride);
  if (subject.casts != BeamKind::any) return result;
  result.add(cast_large(*renderer, large, tall_scanner(4), kStride));
  Beams scattered = unstructured_probes({}, {});
  for (std::uint32_t i = 0; i < 28; ++i) {
    const Beams part = random_probes(kNumber + 1 + i, 0.5, 0.2);
    scattered.cols += part.cols;
    scattered.directions.insert(scattered.directions.end(), part.directions.begin(),
                                part.directions.end());
    scattered.origins_m.insert(scattered.origins_m.end(), part.origins_m.begin(),
                               part.origins_m.end());
  }
  result.add(cast_large(*renderer, large, scattered, kStride));
  return result;
}

VerifyResult thousand_instances(const VerifySubject& subject, const std::vector<Shape>& shapes) {
  constexpr std::uint32_t kNumber = 90300;
  constexpr std::uint32_t kColumns = 40;
  constexpr std::uint32_t kInstances = 1000;
  LargeScene large{.scene = {}, .exact = {}, .world_from_sensor = somewhere(kNumber)};
  large.exact.edge_tolerance_m = kSilhouette * 100.0;
  for (std::uint32_t i = 0; i < kInstances; ++i) {
    const std::uint32_t row = i / kColumns;
    const Eigen::Vector3d in_sensor((i % kColumns) - 19.5, row - 12.0, 40.0);
    // boxes and tetrahedra
    place(shapes[i % 2 == 0 ? 0 : 2], 0.45,
          make_pose(large.world_from_sensor * in_sensor,
                    random_rotation(probe_uniforms(kNumber, 1 + i))),
          large);
  }
  const std::unique_ptr<Renderer> renderer = subject.make(large.scene);
  VerifyResult result = cast_large(*renderer, large, wide_camera(96, 60, 0.62), 1);
  if (subject.casts == BeamKind::any)
    result.add(cast_large(*renderer, large, random_probes(kNumber, 0.45, 0.2), 1));
  return result;
}

constexpr std::uint32_t kGridSteps = 132;  // of a face; the box has 209,088 triangles

/// A point of the grid on a face of the box. Coordinates along which the face is flat stay the
/// same.
Eigen::Vector3f grid_point(const Mesh& box, const std::vector<std::uint32_t>& face,
                           std::uint32_t row, std::uint32_t col) {
  const Eigen::Vector3f& origin = box.positions_m[face[0]];
  constexpr float kSteps = kGridSteps;
  return origin + (box.positions_m[face[1]] - origin) * static_cast<float>(col) / kSteps +
         (box.positions_m[face[3]] - origin) * static_cast<float>(row) / kSteps;
}

/// The box with every face divided into a grid, and the vertex normals of a sphere.
Shape divided_box(const Shape& box) {
  Shape shape = box;
  shape.mesh.triangles.clear();
  for (const std::vector<std::uint32_t>& face : box.faces) {
    for (std::uint32_t i = 0; i < (kGridSteps + 1) * (kGridSteps + 1); ++i) {
      const std::uint32_t row = i / (kGridSteps + 1);
      const std::uint32_t col = i % (kGridSteps + 1);
      const auto a = static_cast<std::uint32_t>(shape.mesh.positions_m.size());
      const std::uint32_t above = a + kGridSteps + 1;
      shape.mesh.positions_m.push_back(grid_point(box.mesh, face, row, col));
      if (row == kGridSteps || col == kGridSteps) continue;
      shape.mesh.triangles.push_back({a, a + 1, above + 1});
      shape.mesh.triangles.push_back({a, above + 1, above});
    }
  }
  for (const Eigen::Vector3f& vertex : shape.mesh.positions_m)
    shape.mesh.normals.push_back(vertex.normalized());
  return shape;
}

VerifyResult many_triangles(const VerifySubject& subject, const Shape& box) {
  constexpr std::uint32_t kNumber = 90400;
  constexpr double kScale = 2.0;
  const Shape shape = divided_box(box);
  const Eigen::Quaterniond attitude = random_rotation(probe_uniforms(kNumber, 0));
  const Eigen::Vector3d diagonal = attitude * Eigen::Vector3d(1.0, 0.9, 1.1).normalized();
  VerifyResult result;
  for (const double side : {-1.0, 1.0}) {  // all six faces
    LargeScene large{.scene = {},
                     .exact = {},
                     .world_from_sensor =
                         look_at(6.0 * side * diagonal, Eigen::Vector3d::Zero(), {0.1, 0.2, 1.0})};
    large.exact.edge_tolerance_m = kSilhouette * 10.0;
    place(shape, kScale, make_pose(Eigen::Vector3d::Zero(), attitude), large);
    const std::unique_ptr<Renderer> renderer = subject.make(large.scene);
    result.add(cast_large(*renderer, large, wide_camera(120, 120, 0.75), 1));
    if (subject.casts == BeamKind::any)
      result.add(cast_large(*renderer, large, random_probes(kNumber, 0.4, 0.2), 1));
  }
  return result;
}

/// A plane that shows its back.
bool is_hidden(const PlacedShape& placed) {
  return !placed.form.solid && placed.form.sides.front().offset > 0.0L;
}

/// From inside a large body, whose faces are seen from behind, among bodies and planes of which
/// some show their fronts. What is not visible comes last, so that the others keep their numbers.
VerifyResult culled_back_faces(const VerifySubject& subject, const std::vector<Shape>& shapes) {
  constexpr std::uint32_t kNumber = 90500;
  const LargeScene around = bodies_around(shapes, kNumber);
  LargeScene large{.scene = {}, .exact = {}, .world_from_sensor = around.world_from_sensor};
  large.exact.edge_tolerance_m = around.exact.edge_tolerance_m;
  for (const bool hidden : {false, true}) {
    for (std::size_t i = 0; i < around.exact.shapes.size(); ++i) {
      const PlacedShape& placed = around.exact.shapes[i];
      const Instance& instance = around.scene.instances[i];
      if (is_hidden(placed) != hidden) continue;
      add_shape(large.scene, placed.shape.mesh, instance.scale, instance.world_from_object);
      if (!hidden) large.exact.shapes.push_back(placed);
    }
  }
  add_shape(
      large.scene, shapes[0].mesh, 10.0,
      make_pose(around.world_from_sensor.translation(), random_rotation({0.3, 0.6, 0.2, 0.5})));
  const std::unique_ptr<Renderer> renderer = subject.make(large.scene);
  VerifyResult result = cast_large(*renderer, large, wide_camera(160, 120, 0.7), 1, true);
  if (subject.casts != BeamKind::any) return result;
  result.add(cast_large(*renderer, large, scanner_probes(), 3, true));
  result.add(cast_large(*renderer, large, random_probes(kNumber, 0.5, 0.001), 1, true));
  return result;
}

/// Casts of more than 100,000 beams, scenes of 1,000 instances, meshes of more than 100,000
/// triangles with vertex normals, and culled back faces.
void add_large_cases(const std::vector<Shape>& shapes, std::vector<SpecialCase>& cases) {
  cases.push_back({"several tiles", "all", 6.0, BeamKind::pinhole,
                   [&](const auto& s) { return several_tiles(s, shapes); }});
  cases.push_back({"1,000 instances", "box, tetrahedron", 40.0, BeamKind::pinhole,
                   [&](const auto& s) { return thousand_instances(s, shapes); }});
  cases.push_back({"209,088 triangles", shapes[0].name, 4.0, BeamKind::pinhole,
                   [&](const auto& s) { return many_triangles(s, shapes[0]); }});
  cases.push_back({"culled back faces", "all", 6.0, BeamKind::pinhole,
                   [&](const auto& s) { return culled_back_faces(s, shapes); }});
}

// Measurements

double value_of(Real real) {
  return static_cast<double>(real);
}

using RealPoint = Eigen::Matrix<Real, 2, 1>;

/// Where OpenCV's rational model (calib3d) images a point of the plane z = 1.
RealPoint imaged(const RadialTangential& k, const RealPoint& p) {
  const Real r2 = p.squaredNorm();
  const auto power = [&](double a, double b, double c) {
    return 1.0L + static_cast<Real>(a) * r2 + static_cast<Real>(b) * r2 * r2 +
           static_cast<Real>(c) * r2 * r2 * r2;
  };
  const Real radial = power(k.k1, k.k2, k.k3) / power(k.k4, k.k5, k.k6);
  const auto p1 = static_cast<Real>(k.p1);
  const auto p2 = static_cast<Real>(k.p2);
  return {p.x() * radial + 2.0L * p1 * p.x() * p.y() + p2 * (r2 + 2.0L * p.x() * p.x()),
          p.y() * radial + p1 * (r2 + 2.0L * p.y() * p.y()) + 2.0L * p2 * p.x() * p.y()};
}

/// The distance from the axis at which OpenCV's fisheye model images an angle.
Real imaged_radius(const Fisheye& k, Real theta) {
  const Real t2 = theta * theta;
  return theta *
         (1.0L + static_cast<Real>(k.k1) * t2 + static_cast<Real>(k.k2) * t2 * t2 +
          static_cast<Real>(k.k3) * t2 * t2 * t2 + static_cast<Real>(k.k4) * t2 * t2 * t2 * t2);
}

RealPoint image_of(const RadialTangential& k, const RealVector& ray) {
  return imaged(k, {ray.x() / ray.z(), ray.y() / ray.z()});
}

RealPoint image_of(const Fisheye& k, const RealVector& ray) {
  const RealPoint side(ray.x(), ray.y());
  const Real length = side.norm();
  if (length == 0.0L) return {0.0L, 0.0L};
  return side / length * imaged_radius(k, std::atan2(length, ray.z()));
}

/// The radius of the image within which pixels have rays.
Real image_radius(const RadialTangential& k) {
  return imaged(k, {static_cast<Real>(k.max_radius), 0.0L}).x();
}
Real image_radius(const Fisheye& k) {
  return imaged_radius(k, std::numbers::pi_v<Real>);
}

/// Projects the ray of every pixel back into the image.
template <class Lens>
VerifyResult project_rays(const VerifySubject& subject, const Lens& lens, double focal_px) {
  constexpr double kBound_px = 1e-9;
  constexpr Real kBorder = 0.006L;  // more than tangential distortion moves it
  Pinhole camera{.intrinsics = {.width = 160, .height = 120}, .distortion = lens};
  camera.intrinsics.fx = focal_px;
  camera.intrinsics.fy = 1.02 * focal_px;
  camera.intrinsics.cx = 81.3;
  camera.intrinsics.cy = 58.9;
  const PinholeIntrinsics& k = camera.intrinsics;
  const Beams beams = subject.beams_of_camera(camera);
  VerifyResult result;
  for (std::uint32_t i = 0; i < beams.size(); ++i) {
    ++result.rays;
    const std::uint32_t row = i / k.width;
    const RealPoint pixel((i % k.width + k.pixel_centre - k.cx) / k.fx,
                          (row + k.pixel_centre - k.cy) / k.fy);
    const Real inside = image_radius(lens) - pixel.norm();
    const RealVector ray = beams.directions[i].cast<Real>();
    if (std::abs(inside) < kBorder) {
      ++result.near_edges;
    } else if (inside < 0.0L) {
      ++result.compared_misses;
      if (!std::isnan(beams.directions[i].x())) ++result.wrong_hits;
    } else {
      ++result.compared_hits;
      result.check(value_of((image_of(lens, ray) - pixel).norm()) * k.fx, kBound_px);
      result.check(value_of(ray.norm()) - 1.0, 1e-14);
    }
  }
  return result;
}

/// Flat bodies and others of different reflectance, nearer and farther than they are detected.
struct LitScene {
  Scene scene;
  ExactScene exact;
};

constexpr std::array<float, 5> kReflectances = {0.05F, 0.1F, 0.3F, 0.6F, 0.9F};

LitScene lit_bodies(const std::vector<Shape>& shapes) {
  constexpr std::uint32_t kNumber = 90600;
  LitScene lit;
  for (const float reflectance : kReflectances) {
    Material material;
    material.diffuse.setConstant(reflectance);
    material.ambient.setConstant(0.5F * reflectance);
    material.specular.setConstant(0.25F);
    material.shininess = 8.0F;
    material.noise_scale = 1.0F + reflectance;
    lit.scene.materials.push_back(material);
  }
  for (std::uint32_t i = 0; i < 30; ++i) {
    const std::array<double, 4> u = probe_uniforms(kNumber, 2 * i);
    const double distance_m = 5.0 + 10.0 * i;
    const Shape& shape = shapes[i % shapes.size()];
    const Pose pose = make_pose(distance_m * random_direction(u[0], u[1], 0.45),
                                random_rotation(probe_uniforms(kNumber, 2 * i + 1)));
    add_shape(lit.scene, shape.mesh, 0.15 * distance_m, pose);
    lit.scene.instances.back().materials = {
        static_cast<std::uint32_t>((i / shapes.size()) % kReflectances.size())};
    lit.exact.shapes.push_back(
        place_shape(shape, 0.15 * distance_m, relative_pose(pose, Eigen::Vector3d::Zero())));
  }
  lit.exact.edge_tolerance_m = 1e-9;
  return lit;
}

Sensor table_sensor(const Beams& beams) {
  RayTable table;
  table.rows = 1;
  table.cols = beams.cols;
  table.directions = beams.directions;
  Sensor sensor;
  sensor.optics = table;
  sensor.rate_hz = 10.0;
  sensor.limits.along = Limits::Along::range;
  return sensor;
}

/// The colours and coefficients of the material of a hit.
void compare_surface(const Material& material, const Hits& hits, std::size_t i,
                     VerifyResult& result) {
  const auto grey = static_cast<double>(material.diffuse.x());
  const auto check = [&](double found, double exact) { result.check(found - exact, kColumnBound); };
  for (int channel = 0; channel < 3; ++channel)
    check(static_cast<double>(hits.colour[i][channel]), grey);
  check(static_cast<double>(hits.diffuse[i]), grey);
  check(static_cast<double>(hits.reflectance[i].diffuse), grey);
  check(static_cast<double>(hits.reflectance[i].ambient),
        static_cast<double>(material.ambient.x()));
  check(static_cast<double>(hits.reflectance[i].specular),
        static_cast<double>(material.specular.x()));
  check(static_cast<double>(hits.reflectance[i].shininess),
        static_cast<double>(material.shininess));
  check(static_cast<double>(hits.noise_scale[i]), static_cast<double>(material.noise_scale));
}

/// The lidar equation with extinction, S = rho cos / rho_ref (R_ref / R)^2 exp(-2 alpha (R -
/// R_ref)), and its threshold 1.
VerifyResult lidar_equation(const VerifySubject& subject, const std::vector<Shape>& shapes) {
  constexpr double kAlpha_per_m = 1e-3;
  constexpr double kBound = 1e-6;  // signals are float32
  const LitScene lit = lit_bodies(shapes);
  const std::unique_ptr<Renderer> renderer = subject.make(lit.scene);
  Beams beams = random_probes(90700, 0.5, 0.0);
  Sensor sensor = table_sensor(beams);
  sensor.lidar_equation = LidarEquation{
      .reference_reflectance = 0.8, .reference_range_m = 150.0, .extinction_per_m = kAlpha_per_m};
  Simulator simulator(lit.scene, sensor, *renderer);
  Frame frame;
  subject.measure(simulator, make_motion(lit.scene, ConstantPose{}, {}), frame);
  VerifyResult result = compare_cast(lit.exact, Pose::Identity(), *simulator.beams(),
                                     frame.ground_truth, renderer->thread_pool());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const std::uint32_t instance = frame.ground_truth.instance[i];
    if (instance == kInvalidId) {
      if (frame.status[i] != Status::miss) ++result.wrong_hits;
      continue;
    }
    const Material& material = lit.scene.materials[lit.scene.instances[instance].materials[0]];
    compare_surface(material, frame.ground_truth, i, result);
    const auto range_m = static_cast<Real>(frame.ground_truth.range_m[i]);
    const RealVector normal = frame.ground_truth.normal[i].cast<Real>();
    const Real cosine = std::abs(normal.dot(beams.directions[i].cast<Real>()));
    const Real signal = static_cast<Real>(material.diffuse.x()) * cosine / 0.8L *
                        (150.0L / range_m) * (150.0L / range_m) *
                        std::exp(-2.0L * static_cast<Real>(kAlpha_per_m) * (range_m - 150.0L));
    if (std::abs(signal - 1.0L) < 1e-5L) continue;
    const Status expected = signal > 1.0L ? Status::hit : Status::below_threshold;
    if (frame.status[i] != expected) ++(signal > 1.0L ? result.wrong_misses : result.wrong_hits);
    if (expected != Status::hit || frame.status[i] != Status::hit) continue;
    result.check(static_cast<double>(frame.intensity[i]) / value_of(signal) - 1.0, kBound);
    result.check(frame.range_m[i] - frame.ground_truth.range_m[i], 1e-12);
  }
  return result;
}

/// A wall of which the beam covers a part, before another wall: two echoes. The share of the near
/// one is that of a Gaussian left of the border, up to the number of sub-rays.
VerifyResult footprint_on_a_step(const VerifySubject& subject, const Shape& plane) {
  constexpr double kNear_m = 40.0;
  constexpr double kFar_m = 60.0;
  constexpr double kDivergence_rad = 2e-3;  // full width at 1/e^2, 4 sigma
  constexpr double kShareBound = 0.02;
  constexpr double kRangeBound_m = 1e-3;
  const Eigen::Quaterniond facing(
      Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitY()));
  Scene scene;
  // the near wall begins at the boresight x and goes to the left, the far one is everywhere
  add_shape(scene, plane.mesh, 32.0, make_pose({kNear_m, 32.0 * 0.625, 0.0}, facing));
  add_shape(scene, plane.mesh, 64.0, make_pose({kFar_m, 0.0, 0.0}, facing));
  std::vector<Eigen::Vector3d> directions;
  for (int i = -200; i <= 200; ++i)
    directions.push_back(Eigen::Vector3d(1.0, 0.004 * i * kDivergence_rad, 0.0003).normalized());
  Beams beams = unstructured_probes(directions);
  Sensor sensor = table_sensor(beams);
  sensor.lidar_equation = LidarEquation{.reference_reflectance = 1.0, .reference_range_m = 1e4};
  sensor.footprint = Footprint{
      .divergence_x_rad = kDivergence_rad, .divergence_y_rad = kDivergence_rad, .rings = 8};
  sensor.receiver.returns = {{Return::Order::nearest, 0}, {Return::Order::farthest, 0}};
  const std::unique_ptr<Renderer> renderer = subject.make(scene);
  Simulator simulator(scene, sensor, *renderer);
  Frame frame;
  subject.measure(simulator, make_motion(scene, ConstantPose{}, {}), frame);
  VerifyResult result;
  result.may_miss = false;
  const auto signal = [](double range_m) { return 0.8 * (1e4 / range_m) * (1e4 / range_m); };
  for (std::size_t i = 0; i < directions.size(); ++i) {
    ++result.rays;
    const double y = directions[i].y() / directions[i].x();
    const double left = 0.5 * std::erfc(-y / (0.25 * kDivergence_rad) / std::numbers::sqrt2);
    if (left < 0.03 || left > 0.97) {
      ++result.compared_misses;
      continue;
    }
    ++result.compared_hits;
    const std::size_t far = i + directions.size();
    if (frame.status[i] != Status::hit || frame.status[far] != Status::hit) {
      ++result.wrong_misses;
      continue;
    }
    const double near_share = static_cast<double>(frame.intensity[i]) / signal(kNear_m);
    const double far_share = static_cast<double>(frame.intensity[far]) / signal(kFar_m);
    result.check(near_share - left, kShareBound);
    result.check(near_share + far_share - 1.0, 1e-5);
    result.check(frame.range_m[i] - kNear_m / directions[i].x(), kRangeBound_m);
    result.check(frame.range_m[far] - kFar_m / directions[i].x(), kRangeBound_m);
  }
  return result;
}

/// What the library computes apart from casts: rays through lenses, colours and reflectances of
/// surfaces, signals by the lidar equation, echoes of beams with a footprint, and poses and radial
/// velocities of a moving sensor.
void add_measurement_cases(const std::vector<Shape>& shapes, std::vector<SpecialCase>& cases) {
  const auto none = BeamKind::pinhole;
  cases.push_back({"lens", "radial, tangential", 0.0, none, [](const auto& s) {
                     return project_rays(s,
                                         RadialTangential{.k1 = 0.12,
                                                          .k2 = -0.01,
                                                          .p1 = 5e-4,
                                                          .p2 = -4e-4,
                                                          .k3 = 2e-3,
                                                          .k4 = 0.05,
                                                          .k5 = 0.01,
                                                          .k6 = 1e-3,
                                                          .max_radius = 1.2},
                                         60.0);
                   }});
  cases.push_back({"lens", "fisheye", 0.0, none, [](const auto& s) {
                     return project_rays(
                         s, Fisheye{.k1 = -0.01, .k2 = 2e-3, .k3 = -1e-4, .k4 = 1e-5}, 25.0);
                   }});
  cases.push_back({"lidar equation", "all", 150.0, BeamKind::any,
                   [&](const auto& s) { return lidar_equation(s, shapes); }});
  cases.push_back({"footprint", shapes[1].name, 40.0, BeamKind::any,
                   [&](const auto& s) { return footprint_on_a_step(s, shapes[1]); }});
  cases.push_back({"measured motion", shapes.front().name, 10.0, BeamKind::any,
                   [&](const auto& s) { return measured_motion(s, shapes); }});
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
  cases.push_back({"scanner among bodies", "all", 5.0, BeamKind::any,
                   [&](const auto& s) { return scanner_among_bodies(s, shapes); }});
  cases.push_back({"moving sensor and target", shapes.front().name, 10.0, BeamKind::any,
                   [&](const auto& s) { return moving_sensor_and_target(s, shapes); }});
  cases.push_back({"sensor in traffic", "box, tetrahedron", 40.0, BeamKind::any,
                   [&](const auto& s) { return sensor_in_traffic(s, shapes); }});
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
