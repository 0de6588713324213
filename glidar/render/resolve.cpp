// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/resolve.hpp>

#include <glidar/render/surface.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace glidar {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr float kNaNf = std::numeric_limits<float>::quiet_NaN();

Eigen::Vector3d corner(const Mesh& mesh, std::uint32_t triangle, std::size_t k) {
  return mesh.positions_m[mesh.triangles[triangle][k]].cast<double>();
}

/// Everything of one hit that the optional columns are made of.
struct ExactHit {
  const InstanceView& view;
  const TrianglePlane& plane;
  bool from_behind;       ///< the beam meets the back of the triangle
  Eigen::Vector3d point;  ///< object units, relative to the mesh's origin
};

/// A vector of the object's front side, in the sensor's frame and turned to the sensor.
Eigen::Vector3f to_sensor(const ExactHit& hit, const Eigen::Vector3d& in_object) {
  const Eigen::Vector3d in_sensor = hit.view.object_from_sensor.transpose() * in_object;
  return (hit.from_behind ? -in_sensor : in_sensor).cast<float>();
}

/// The columns that need the place on the triangle.
void write_surface(const Scene& scene, const HitFields& fields, const SurfacePlace& place,
                   const ExactHit& hit, std::size_t beam, Hits& hits) {
  if (fields.barycentrics) hits.barycentrics[beam] = place.weights;
  if (fields.shading_normal) {
    const Eigen::Vector3f normal = shading_normal_at(scene, place, hit.plane.normal.cast<float>());
    hits.shading_normal[beam] = to_sensor(hit, normal.cast<double>());
  }
  if (fields.surface) {
    const SurfaceColour colour = colour_at(scene, place);
    hits.colour[beam] = colour.diffuse;
    hits.ambient[beam] = colour.ambient;
    hits.specular[beam] = colour.specular;
    hits.shininess[beam] = colour.shininess;
  }
}

}  // namespace

std::vector<TrianglePlane> triangle_planes(const Mesh& mesh) {
  std::vector<TrianglePlane> planes(mesh.triangles.size());
  for (std::uint32_t i = 0; i < planes.size(); ++i) {
    const Eigen::Vector3d v0 = corner(mesh, i, 0);
    const Eigen::Vector3d cross = (corner(mesh, i, 1) - v0).cross(corner(mesh, i, 2) - v0);
    planes[i].normal = cross / cross.norm();
    planes[i].offset = planes[i].normal.dot(v0);
  }
  return planes;
}

InstanceView view_of(const Instance& instance, const Mesh& mesh, const Pose& world_from_object,
                     const Pose& world_from_sensor) {
  const Eigen::Matrix3d object_from_world = world_from_object.linear().transpose();
  // The difference of two far-away positions first: it is exact where their sum would not be.
  const Eigen::Vector3d offset = world_from_sensor.translation() - world_from_object.translation();
  return {.object_from_sensor = object_from_world * world_from_sensor.linear(),
          .sensor_in_object = object_from_world * offset / instance.scale - mesh.origin_m,
          .scale = instance.scale};
}

ObjectRay ray_in(const InstanceView& view, const Beams& beams, std::size_t beam) {
  ObjectRay ray{view.sensor_in_object, view.object_from_sensor * beams.directions[beam]};
  if (!beams.origins_m.empty()) {
    ray.origin += view.object_from_sensor * beams.origins_m[beam] / view.scale;
  }
  return ray;
}

Eigen::Vector2d barycentrics(const Mesh& mesh, std::uint32_t triangle, const TrianglePlane& plane,
                             const Eigen::Vector3d& point) {
  const Eigen::Vector3d v0 = corner(mesh, triangle, 0);
  const Eigen::Vector3d e1 = corner(mesh, triangle, 1) - v0;
  const Eigen::Vector3d e2 = corner(mesh, triangle, 2) - v0;
  const Eigen::Vector3d w = point - v0;
  const double twice_area = plane.normal.dot(e1.cross(e2));
  return {plane.normal.dot(w.cross(e2)) / twice_area, plane.normal.dot(e1.cross(w)) / twice_area};
}

Resolver::Resolver(const Scene& scene) : scene_(scene) {
  planes_.reserve(scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) planes_.push_back(triangle_planes(mesh));
  planes_of_instance_.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) {
    planes_of_instance_.push_back(&planes_[instance.mesh]);
  }
}

void Resolver::set_poses(const Pose& world_from_sensor, std::span<const Pose> world_from_instance) {
  views_.resize(scene_.instances.size());
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const Instance& instance = scene_.instances[i];
    const Pose& pose =
        world_from_instance.empty() ? instance.world_from_object : world_from_instance[i];
    views_[i] = view_of(instance, scene_.meshes[instance.mesh], pose, world_from_sensor);
  }
}

void Resolver::write_hit(const Beams& beams, const HitFields& fields, std::size_t beam,
                         std::uint32_t instance, std::uint32_t primitive, Hits& hits) const {
  const InstanceView& in = views_[instance];
  const TrianglePlane& triangle = plane(instance, primitive);
  const ObjectRay ray = ray_in(in, beams, beam);
  const double cosine = triangle.normal.dot(ray.direction);
  const double distance = (triangle.offset - triangle.normal.dot(ray.origin)) / cosine;

  hits.range_m[beam] = distance * in.scale;
  hits.instance[beam] = instance;
  hits.primitive[beam] = primitive;
  if (fields.incidence) hits.cos_incidence[beam] = static_cast<float>(std::abs(cosine));
  const ExactHit hit{in, triangle, cosine > 0.0, ray.origin + distance * ray.direction};
  if (fields.normal) hits.normal[beam] = to_sensor(hit, triangle.normal);
  if (fields.depth) {
    Eigen::Vector3d in_sensor = hits.range_m[beam] * beams.directions[beam];
    if (!beams.origins_m.empty()) in_sensor += beams.origins_m[beam];
    hits.depth_m[beam] = in_sensor.dot(beams.boresight);
  }
  const Mesh& hit_mesh = mesh(instance);
  if (fields.object_point) hits.object_point_m[beam] = hit_mesh.origin_m + hit.point;
  if (fields.barycentrics || fields.shading_normal || fields.surface) {
    const Eigen::Vector2f weights =
        barycentrics(hit_mesh, primitive, triangle, hit.point).cast<float>();
    write_surface(scene_, fields, {hit_mesh, scene_.instances[instance], primitive, weights}, hit,
                  beam, hits);
  }
}

void Resolver::write_miss(const HitFields& fields, std::size_t beam, Hits& hits) {
  hits.range_m[beam] = kNaN;
  hits.instance[beam] = kNoHit;
  hits.primitive[beam] = kNoHit;
  if (fields.depth) hits.depth_m[beam] = kNaN;
  if (fields.normal) hits.normal[beam].setConstant(kNaNf);
  if (fields.shading_normal) hits.shading_normal[beam].setConstant(kNaNf);
  if (fields.incidence) hits.cos_incidence[beam] = kNaNf;
  if (fields.barycentrics) hits.barycentrics[beam].setConstant(kNaNf);
  if (fields.object_point) hits.object_point_m[beam].setConstant(kNaN);
  if (!fields.surface) return;
  hits.colour[beam].setZero();
  hits.ambient[beam] = 0.0F;
  hits.specular[beam] = 0.0F;
  hits.shininess[beam] = 0.0F;
}

}  // namespace glidar
