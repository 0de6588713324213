// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/hits.hpp>
#include <glidar/core/scene.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// The plane of a triangle, n . p = offset, in the mesh's frame relative to Mesh::origin_m.
/// n is the unit normal of the front; NaN for a triangle without area.
struct TrianglePlane {
  Eigen::Vector3d normal;
  double offset;
};

/// One per triangle, in double from the mesh's vertices.
std::vector<TrianglePlane> triangle_planes(const Mesh& mesh);

/// The sensor as one instance sees it: object units, relative to the mesh's origin.
struct InstanceView {
  Eigen::Matrix3d object_from_sensor;  ///< rotation
  Eigen::Vector3d sensor_in_object;    ///< the sensor's origin
  double scale;                        ///< metres per object unit
};

InstanceView view_of(const Instance& instance, const Mesh& mesh, const Pose& world_from_object,
                     const Pose& world_from_sensor);

/// A beam in an instance's view: origin and unit direction.
struct ObjectRay {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

ObjectRay ray_in(const InstanceView& view, const Beams& beams, std::size_t beam);

/// Distance along the ray to the plane, object units: t = (offset - n.o) / (n.d).
inline double distance_to(const TrianglePlane& plane, const ObjectRay& ray) {
  return (plane.offset - plane.normal.dot(ray.origin)) / plane.normal.dot(ray.direction);
}

/// Weights of the triangle's corners 1 and 2 at a point of its plane, in double.
Eigen::Vector2d barycentrics(const Mesh& mesh, std::uint32_t triangle, const TrianglePlane& plane,
                             const Eigen::Vector3d& point);

/// The smallest weight of the three; negative outside the triangle.
inline double inside_margin(const Eigen::Vector2d& weights) {
  return std::min({weights.x(), weights.y(), 1.0 - weights.x() - weights.y()});
}

/// Turns (beam, instance, primitive) into exact hit columns. Shared by all renderers, so that the
/// numbers do not depend on who found the triangle.
class Resolver {
 public:
  /// The scene must outlive the resolver.
  explicit Resolver(const Scene& scene);

  /// Takes the poses of the next cast; empty `world_from_instance` means the scene's own.
  void set_poses(const Pose& world_from_sensor, std::span<const Pose> world_from_instance);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const InstanceView& view(std::uint32_t instance) const { return views_[instance]; }
  [[nodiscard]] const TrianglePlane& plane(std::uint32_t instance, std::uint32_t primitive) const {
    return (*planes_of_instance_[instance])[primitive];
  }
  [[nodiscard]] const Mesh& mesh(std::uint32_t instance) const {
    return scene_.meshes[scene_.instances[instance].mesh];
  }

  /// Writes a hit's columns at index `beam`. `hits` has been resized with `fields`.
  void write_hit(const Beams& beams, const HitFields& fields, std::size_t beam,
                 std::uint32_t instance, std::uint32_t primitive, Hits& hits) const;

  /// Writes a miss.
  static void write_miss(const HitFields& fields, std::size_t beam, Hits& hits);

 private:
  const Scene& scene_;
  std::vector<std::vector<TrianglePlane>> planes_;                     ///< per mesh
  std::vector<const std::vector<TrianglePlane>*> planes_of_instance_;  ///< per instance
  std::vector<InstanceView> views_;                                    ///< per instance
};

}  // namespace glidar
