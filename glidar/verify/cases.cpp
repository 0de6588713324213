// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/cases.hpp>

#include <glidar/math/portable.hpp>
#include <glidar/verify/comparison.hpp>
#include <glidar/verify/probes.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace glidar {
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
