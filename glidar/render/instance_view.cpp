// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/instance_view.hpp>

#include <glidar/math/double_double.hpp>
#include <glidar/math/simd.hpp>

namespace glidar {
namespace {

/// The sensor's position relative to that of the mesh's origin, in the axes of the world, rounded
/// once: a mesh whose vertices are 1000 km from its origin would lose 1e-10 m if that offset were
/// rotated in double.
Eigen::Vector3d from_mesh_origin(const Instance& instance, const Mesh& mesh,
                                 const Pose& world_from_object, const Pose& world_from_sensor) {
  Eigen::Vector3d offset;
  for (int row = 0; row < 3; ++row) {
    DoubleDouble sum = exact_sum(world_from_sensor(row, 3), -world_from_object(row, 3));
    for (int col = 0; col < 3; ++col) {
      sum -= exact_product(instance.scale, mesh.origin_m[col]) * world_from_object(row, col);
    }
    offset[row] = sum.high;
  }
  return offset;
}

}  // namespace

InstanceView view_of(const Instance& instance, const Mesh& mesh, const Pose& world_from_object,
                     const Pose& world_from_sensor) {
  const Eigen::Matrix3d object_from_world = world_from_object.linear().transpose();
  return {
      .object_from_sensor = object_from_world * world_from_sensor.linear(),
      .sensor_in_object = object_from_world *
                          from_mesh_origin(instance, mesh, world_from_object, world_from_sensor) /
                          instance.scale,
      .scale = instance.scale};
}

Eigen::Matrix<double, 3, 4> sensor_from_object(const InstanceView& view) {
  const Eigen::Matrix3d rotation = view.scale * view.object_from_sensor.transpose();
  Eigen::Matrix<double, 3, 4> matrix;
  matrix << rotation, -(rotation * view.sensor_in_object);
  return matrix;
}

ObjectRay ray_in(const InstanceView& view, const Beams& beams, std::size_t beam) {
  const Eigen::Matrix3d& rotation = view.object_from_sensor;
  ObjectRay ray{view.sensor_in_object, rotate(rotation, beams.directions[beam])};
  if (!beams.origins_m.empty()) ray.origin += rotate(rotation, beams.origins_m[beam]) / view.scale;
  return ray;
}

GLIDAR_SIMD void rays_in(const InstanceView& view, const BeamBlock& beams, Lanes3<double>& origin,
                         Lanes3<double>& direction) {
  rotate(view.object_from_sensor, beams.direction, direction);
  const Eigen::Vector3d& sensor = view.sensor_in_object;
  for (unsigned i = 0; i < kLanes; ++i) origin.x[i] = sensor.x();
  for (unsigned i = 0; i < kLanes; ++i) origin.y[i] = sensor.y();
  for (unsigned i = 0; i < kLanes; ++i) origin.z[i] = sensor.z();
  if (!beams.has_origins) return;
  Lanes3<double> offset_m;
  rotate(view.object_from_sensor, beams.origin_m, offset_m);
  if (view.scale != 1.0) {  // divisions take half of the time
    for (unsigned i = 0; i < kLanes; ++i) offset_m.x[i] /= view.scale;
    for (unsigned i = 0; i < kLanes; ++i) offset_m.y[i] /= view.scale;
    for (unsigned i = 0; i < kLanes; ++i) offset_m.z[i] /= view.scale;
  }
  for (unsigned i = 0; i < kLanes; ++i) origin.x[i] += offset_m.x[i];
  for (unsigned i = 0; i < kLanes; ++i) origin.y[i] += offset_m.y[i];
  for (unsigned i = 0; i < kLanes; ++i) origin.z[i] += offset_m.z[i];
}

}  // namespace glidar
