// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/hits.hpp>
#include <glidar/core/mesh.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/render/hit_block.hpp>
#include <glidar/render/lanes.hpp>
#include <glidar/render/planes.hpp>
#include <glidar/render/surface.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// The sensor in the frame of an instance: object units, relative to the mesh's origin.
struct InstanceView {
  Eigen::Matrix3d object_from_sensor;  ///< rotation
  Eigen::Vector3d sensor_in_object;    ///< the sensor's origin
  double scale;                        ///< metres per object unit
};

InstanceView view_of(const Instance& instance, const Mesh& mesh, const Pose& world_from_object,
                     const Pose& world_from_sensor);

/// From a point relative to the mesh's origin into the sensor's frame, metres.
Eigen::Matrix<double, 3, 4> sensor_from_object(const InstanceView& view);

/// A beam in an instance's view: origin and unit direction.
struct ObjectRay {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

ObjectRay ray_in(const InstanceView& view, const Beams& beams, std::size_t beam);

/// The beams of a block, in the sensor frame.
struct BeamBlock {
  Lanes3<double> direction;
  Lanes3<double> origin_m;
  bool has_origins = false;  ///< else they start at the sensor's origin, and origin_m is unset
};

/// The beams in an instance's frame, lane by lane as ray_in().
void rays_in(const InstanceView& view, const BeamBlock& beams, Lanes3<double>& origin,
             Lanes3<double>& direction);

struct BlockKernel;

/// True when a material of the instance has an alpha mask.
bool has_mask(const Scene& scene, const Instance& instance);

/// Distance along the ray to the plane, object units: t = (offset - n.o) / (n.d).
inline double distance_to(const TrianglePlane& plane, const ObjectRay& ray) {
  return (plane.offset - plane.normal.dot(ray.origin)) / plane.normal.dot(ray.direction);
}

/// The exact geometry of a block's hits, in the objects' frames and units.
struct ExactHits {
  CornerBlock corners;  ///< of the triangle, relative to the mesh's origin, if has_corners
  bool has_corners;
  Lanes3<double> normal;     ///< of the triangle's front
  Lanes3<double> origin;     ///< of the beam
  Lanes3<double> direction;  ///< of the beam
  Lanes<double> offset;      ///< of the triangle's plane
  Lanes<double> cosine;      ///< of normal and direction; positive: seen from behind
  Lanes<double> distance;    ///< along the beam
};

/// A block of beams with their hits and the exact geometry of these.
struct HitBatch {
  HitBlock block;
  BeamBlock beams;
  ExactHits exact;
};

/// 4 MiB of planes.
inline constexpr std::size_t kMaxStoredPlanes = std::size_t{128} * 1024;

/// Computes hit columns from (beam, instance, primitive) in double. All renderers share it, so the
/// results do not depend on how a triangle was found.
class Resolver {
 public:
  /// The scene must outlive the resolver.
  explicit Resolver(const Scene& scene);

  /// Sets the poses of the next cast; empty `world_from_instance`: the scene's own.
  void set_poses(const Pose& world_from_sensor, std::span<const Pose> world_from_instance);

  /// Stores planes, and uses them until the next set_poses(), for casts whose columns need no
  /// corners, from which planes are computed otherwise. Only in scenes of at most
  /// kMaxStoredPlanes triangles, where gathering planes is faster: more do not fit into caches.
  void use_stored_planes(const HitColumnMask& hit_columns, ThreadPool& thread_pool);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const InstanceView& view(std::uint32_t instance) const { return views_[instance]; }
  [[nodiscard]] TrianglePlane plane(std::uint32_t instance, std::uint32_t primitive) const {
    return plane_of(mesh(instance), primitive);
  }
  [[nodiscard]] const Mesh& mesh(std::uint32_t instance) const {
    return *instances_[instance].mesh;
  }

  /// The triangle to report: itself, or the first of those coincident with it. With culling of back
  /// faces, windings matter, so renderers report the triangle itself.
  [[nodiscard]] std::uint32_t canonical_primitive(std::uint32_t instance,
                                                  std::uint32_t primitive) const {
    const std::uint32_t* first_coincident = instances_[instance].first_coincident;
    return first_coincident == nullptr ? primitive : first_coincident[primitive];
  }

  /// canonical_primitive() per triangle of an instance; nullptr: each is its own.
  [[nodiscard]] const std::uint32_t* first_coincident(std::uint32_t instance) const {
    return instances_[instance].first_coincident;
  }

  /// The triangles of a mesh that a cast may report; empty: all of them.
  [[nodiscard]] std::span<const std::uint32_t> distinct(std::size_t mesh) const {
    return distinct_[mesh];
  }

  /// True when a material of the instance has an alpha mask.
  [[nodiscard]] bool is_masked(std::uint32_t instance) const {
    return instances_[instance].is_masked;
  }

  /// Prefetches a lane's triangle.
  void prefetch(const HitBlock& block, unsigned lane) const {
    const std::uint32_t instance = block.instance[lane];
    const std::uint32_t primitive = block.primitive[lane];
    if (uses_planes_) {
      __builtin_prefetch(planes_of(instance) + primitive);
    } else {
      __builtin_prefetch(instances_[instance].triangles + primitive);
    }
  }

  /// Prefetches the triangles of a block's lanes, which are all of one instance.
  void prefetch_one_instance(const HitBlock& block) const {
    const InstanceData& of = instances_[block.instance[0]];
    const auto* const first = uses_planes_
                                  ? reinterpret_cast<const char*>(planes_of(block.instance[0]))
                                  : reinterpret_cast<const char*>(of.triangles);
    const std::size_t bytes = uses_planes_ ? sizeof(TrianglePlane) : sizeof(Triangle);
    for (const std::uint32_t primitive : block.primitive) {
      __builtin_prefetch(first + bytes * primitive);
    }
  }

  /// Gathers the corners of a block's triangles, unless intersect() did.
  void gather_corners(const HitBlock& block, ExactHits& exact) const;

  /// Prefetches corners of a block's triangles, unless only their planes are used, and the normals
  /// if the columns need them.
  void prefetch_corners(const HitBlock& block, const HitColumnMask& hit_columns) const;

  /// Computes distance and incidence of a block with at least one hit. Lanes without a hit get the
  /// ids of one that has.
  void intersect(const BeamBlock& beams, HitBlock& block, ExactHits& exact) const;

  /// Writes the columns of an intersected block.
  void write(const Beams& beams, const HitColumnMask& hit_columns, const HitBlock& block,
             const ExactHits& exact, Hits& hits) const;

  /// Intersects and writes the hits of a batch, if there are any.
  void write_batch(const Beams& beams, const HitColumnMask& hit_columns, HitBatch& batch,
                   Hits& hits) const;

  /// Writes the diffuse colour of the `count` beams behind each of a block, which all hit the
  /// triangle of that one. Requires ids of all lanes, also of those that are not in use.
  void write_diffuse_behind(const Beams& beams, std::size_t count, HitBatch& batch,
                            Hits& hits) const;

 private:
  void intersect_triangles(const BeamBlock& beams, const HitBlock& block, ExactHits& exact) const;
  void write_ranges(const HitBlock& block, const ExactHits& exact, Hits& hits) const;
  void write_directions(const HitBlock& block, const Lanes3<double>& front,
                        const Lanes<double>& cosine, std::vector<Eigen::Vector3f>& column) const;
  [[nodiscard]] const TrianglePlane* planes_of(std::uint32_t instance) const {
    return planes_[scene_.instances[instance].mesh].data();
  }
  void gather_normals(const HitBlock& block, CornerBlock& normals) const;
  void set_triangles(const HitBlock& block, ExactHits& exact) const;
  /// Barycentric weights of corners 1 and 2 per lane, and the normals that they interpolate.
  struct Weights {
    const Lanes<float>& w1;
    const Lanes<float>& w2;
    const CornerBlock& normals;
  };
  void write_shading(const HitColumnMask& hit_columns, const HitBlock& block,
                     const ExactHits& exact, const Weights& weights, Hits& hits) const;
  void write_surface(const HitColumnMask& hit_columns, const HitBlock& block,
                     const ExactHits& exact, Hits& hits) const;
  [[nodiscard]] SurfacePoint surface_point_at(const HitBlock& block, unsigned lane,
                                              const Lanes<float>& w1, const Lanes<float>& w2) const;
  void apply_normal_maps(const HitBlock& block, const Lanes<float>& w1, const Lanes<float>& w2,
                         Lanes3<double>& normals) const;

  /// Pointers to an instance's data, for few indirections.
  struct InstanceData {
    const Mesh* mesh;
    const Triangle* triangles;
    const Eigen::Vector3f* positions_m;
    const Eigen::Vector3f* normals;         ///< nullptr: flat shading
    const std::uint32_t* first_coincident;  ///< nullptr: all triangles differ
    bool has_normal_map;                    ///< in some slot
    bool is_masked;                         ///< see Resolver::is_masked()
  };

  const Scene& scene_;
  const BlockKernel& kernel_;
  bool may_store_planes_;
  bool uses_planes_ = false;                                  ///< in the current cast
  std::vector<std::vector<TrianglePlane>> planes_;            ///< per mesh; empty: not stored
  std::vector<std::vector<std::uint32_t>> first_coincident_;  ///< per mesh
  std::vector<std::vector<std::uint32_t>> distinct_;          ///< per mesh, see distinct()
  std::vector<InstanceData> instances_;                       ///< per instance
  bool has_normal_maps_ = false;                              ///< of some instance
  SurfaceColours colours_;
  std::vector<InstanceView> views_;  ///< per instance
};

/// For meshes with coincident triangles (same corners in any order): the first of each group, per
/// triangle, so that every renderer reports the same one. Empty when there are none.
std::vector<std::uint32_t> find_first_coincident(const Mesh& mesh);

/// The triangles of a mesh without copies, which have the same corners and winding as an earlier
/// one. Rising indices; empty when there are no copies. `firsts`: find_first_coincident(mesh).
std::vector<std::uint32_t> distinct_triangles(const Mesh& mesh,
                                              const std::vector<std::uint32_t>& firsts);

}  // namespace glidar
