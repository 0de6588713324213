// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/large_cases.hpp>

#include <glidar/verify/comparison.hpp>
#include <glidar/verify/probes.hpp>

#include <array>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

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
  if (subject.casts >= BeamKind::scanner)
    result.add(cast_large(*renderer, large, tall_scanner(4), kStride));
  if (subject.casts < BeamKind::any) return result;
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
  if (subject.casts >= BeamKind::scanner)
    result.add(cast_large(*renderer, large, scanner_probes(), 3, true));
  if (subject.casts == BeamKind::any)
    result.add(cast_large(*renderer, large, random_probes(kNumber, 0.5, 0.001), 1, true));
  return result;
}

}  // namespace

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

}  // namespace glidar
