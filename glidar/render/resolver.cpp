// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/resolver.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/double_double.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/render/block_kernel.hpp>
#include <glidar/render/common/triangle_blocks.hpp>
#include <glidar/render/corners.hpp>
#include <glidar/render/rays/kernels.hpp>
#include <glidar/render/uncertain_hits.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <string_view>

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

/// The kernel with the instruction set of the ray caster's (rays::select_kernel()).
const BlockKernel& select_block_kernel();

namespace rays::baseline {
extern const BlockKernel kBlockKernel;
}
#ifdef __x86_64__
namespace rays::avx2 {
extern const BlockKernel kBlockKernel;
}
namespace rays::avx512 {
extern const BlockKernel kBlockKernel;
}
#endif

const BlockKernel& select_block_kernel() {
#ifdef __x86_64__
  const std::string_view name = rays::select_kernel().name;
  if (name == rays::avx512::kBlockKernel.name) return rays::avx512::kBlockKernel;
  if (name == rays::avx2::kBlockKernel.name) return rays::avx2::kBlockKernel;
#endif
  return rays::baseline::kBlockKernel;
}

/// Replaces the distances of a block's hits by those of the hit rule where the plane is not
/// accurate enough: at grazing incidence, and close to the beam's start. The rule's distance is
/// always between those of the triangle's corners. A triangle without area, which a beam hits only
/// by rounding, gets a plane that faces the beam.
void intersect_grazing(const Resolver& resolver, const HitBlock& block, ExactHits& exact);

namespace {

/// Sets the plane of a triangle without area, which a beam hits only by rounding: it contains the
/// longest edge and faces the beam as far as possible.
void set_facing_plane(unsigned lane, const HitTriangle& triangle, ExactHits& exact) {
  const auto vector = [](const std::array<float, 3>& p) {
    return Eigen::Vector3d(double{p[0]}, double{p[1]}, double{p[2]});
  };
  const Eigen::Vector3d a = vector(triangle.a);
  Eigen::Vector3d edge = vector(triangle.b) - a;
  const Eigen::Vector3d other = vector(triangle.c) - a;
  if (other.squaredNorm() > edge.squaredNorm()) edge = other;
  const Eigen::Vector3d d = exact.direction.get(lane);
  const Eigen::Vector3d along = edge.normalized();
  const Eigen::Vector3d normal = (along * along.dot(d) - d).normalized();
  exact.normal.set(lane, normal);
  exact.offset[lane] = normal.dot(a);
  exact.cosine[lane] = normal.dot(d);
}

/// 0 where the plane is accurate enough for a lane, else 1. An integer, so that loops vectorise.
[[gnu::always_inline]] inline unsigned is_uncertain(const ExactHits& exact, unsigned lane) {
  const auto is_steep = static_cast<unsigned>(std::abs(exact.cosine[lane]) > kGrazing);
  const auto is_ahead = static_cast<unsigned>(exact.distance[lane] > 0.0);
  return (is_steep & is_ahead) ^ 1U;
}

/// True when the planes are accurate enough for all lanes.
GLIDAR_SIMD bool are_all_certain(const ExactHits& exact) {
  unsigned unsure = 0;
  for (unsigned i = 0; i < kLanes; ++i) unsure |= is_uncertain(exact, i);
  return unsure == 0;
}

}  // namespace

void intersect_grazing(const Resolver& resolver, const HitBlock& block, ExactHits& exact) {
  if (are_all_certain(exact)) return;
  std::uint32_t unsure = 0;
  for (unsigned i = 0; i < kLanes; ++i) unsure |= is_uncertain(exact, i) << i;
  for_lanes(unsure & block.mask, [&](unsigned i) {
    const HitRay ray = make_hit_ray(exact.origin.get(i), exact.direction.get(i));
    const HitTriangle corners = corners_of(resolver.mesh(block.instance[i]), block.primitive[i]);
    if (std::isnan(exact.offset[i])) set_facing_plane(i, corners, exact);
    const double distance = hit_distance(ray, corners);
    if (distance > 0.0) exact.distance[i] = distance;
  });
}

// Barycentric weights and what is interpolated with them, lane by lane.

/// Barycentric weights of corners 1 and 2 at the hit point.
void interpolate_weights(const ExactHits& e, const CornerBlock& c, Lanes<float>& w1,
                         Lanes<float>& w2);

/// w0 a + w1 b + w2 c, normalised; `flat` where that has no length.
void blend_normals(const CornerBlock& n, const Lanes<float>& w1, const Lanes<float>& w2,
                   const Lanes3<double>& flat, Lanes3<double>& out);

/// Cosines between -beams and normals; normals are on the side of the plane's and are turned to the
/// sensor.
void cosines(const ExactHits& e, const Lanes3<double>& normal, Lanes<float>& out);

GLIDAR_SIMD void interpolate_weights(const ExactHits& e, const CornerBlock& c, Lanes<float>& w1,
                                     Lanes<float>& w2) {
  constexpr float kThird = 1.0F / 3.0F;
  for (unsigned i = 0; i < kLanes; ++i) {
    const CornerAreas areas = areas_around(e, c, i);
    const float whole = areas.at_0 + areas.at_1 + areas.at_2;
    const bool has_area = whole != 0.0F;
    w1[i] = has_area ? areas.at_1 / whole : kThird;
    w2[i] = has_area ? areas.at_2 / whole : kThird;
  }
}

GLIDAR_SIMD void blend_normals(const CornerBlock& n, const Lanes<float>& w1, const Lanes<float>& w2,
                               const Lanes3<double>& flat, Lanes3<double>& out) {
  constexpr float kShortest = 1e-12F;  // squared; opposite normals cancel out
  for (unsigned i = 0; i < kLanes; ++i) {
    const float w0 = 1.0F - w1[i] - w2[i];
    const float x = w0 * n.c0.x[i] + w1[i] * n.c1.x[i] + w2[i] * n.c2.x[i];
    const float y = w0 * n.c0.y[i] + w1[i] * n.c1.y[i] + w2[i] * n.c2.y[i];
    const float z = w0 * n.c0.z[i] + w1[i] * n.c1.z[i] + w2[i] * n.c2.z[i];
    const float squared = x * x + y * y + z * z;
    const bool has_length = squared > kShortest;
    const float inverse = 1.0F / std::sqrt(has_length ? squared : 1.0F);
    out.x[i] = has_length ? static_cast<double>(x * inverse) : flat.x[i];
    out.y[i] = has_length ? static_cast<double>(y * inverse) : flat.y[i];
    out.z[i] = has_length ? static_cast<double>(z * inverse) : flat.z[i];
  }
}

GLIDAR_SIMD void cosines(const ExactHits& e, const Lanes3<double>& normal, Lanes<float>& out) {
  for (unsigned i = 0; i < kLanes; ++i) {
    const double along = normal.x[i] * e.direction.x[i] + normal.y[i] * e.direction.y[i] +
                         normal.z[i] * e.direction.z[i];
    out[i] = static_cast<float>(e.cosine[i] > 0.0 ? along : -along);
  }
}

namespace {

/// The lanes that did not hit this instance.
std::uint32_t lanes_not_on(const HitBlock& block, std::uint32_t instance) {
  if (block.is_one_triangle && block.instance[0] == instance) return 0;
  std::uint32_t others = 0;
  for (unsigned i = 0; i < kLanes; ++i) {
    others |= static_cast<std::uint32_t>(block.instance[i] != instance) << i;
  }
  return others;
}

/// Copies the rays of the lanes that hit the instance.
GLIDAR_SIMD void copy_rays(const HitBlock& block, std::uint32_t instance, const ExactHits& source,
                           ExactHits& exact) {
  for (unsigned i = 0; i < kLanes; ++i) {
    const bool is_its = block.instance[i] == instance;
    exact.origin.x[i] = is_its ? source.origin.x[i] : exact.origin.x[i];
    exact.origin.y[i] = is_its ? source.origin.y[i] : exact.origin.y[i];
    exact.origin.z[i] = is_its ? source.origin.z[i] : exact.origin.z[i];
    exact.direction.x[i] = is_its ? source.direction.x[i] : exact.direction.x[i];
    exact.direction.y[i] = is_its ? source.direction.y[i] : exact.direction.y[i];
    exact.direction.z[i] = is_its ? source.direction.z[i] : exact.direction.z[i];
  }
}

/// cosine = n.d, distance = (offset - n.o) / (n.d), as distance_to().
GLIDAR_SIMD void intersect_planes(ExactHits& e) {
  for (unsigned i = 0; i < kLanes; ++i) {
    const double above =
        e.offset[i] - (e.normal.x[i] * e.origin.x[i] + e.normal.y[i] * e.origin.y[i] +
                       e.normal.z[i] * e.origin.z[i]);
    const double cosine = e.normal.x[i] * e.direction.x[i] + e.normal.y[i] * e.direction.y[i] +
                          e.normal.z[i] * e.direction.z[i];
    e.cosine[i] = cosine;
    e.distance[i] = above / cosine;
  }
}

/// Gathers vectors of one mesh's vertices.
TrianglesToGather gather_from(const Eigen::Vector3f* of_vertex, const Triangle* triangles,
                              const HitBlock& block) {
  return {.of_vertex = of_vertex->data(),
          .vertices = triangles->data(),
          .primitive = block.primitive.data()};
}

void set_corners(unsigned lane, const Eigen::Vector3f* of_vertex, const Triangle& triangle,
                 CornerBlock& corners) {
  corners.c0.set(lane, of_vertex[triangle[0]]);
  corners.c1.set(lane, of_vertex[triangle[1]]);
  corners.c2.set(lane, of_vertex[triangle[2]]);
}

bool needs_normals(const HitColumnMask& hit_columns) {
  return hit_columns.shading_normal || hit_columns.shading;
}

/// True when some of the columns depend on the position of a hit within its triangle.
bool needs_corners(const HitColumnMask& hit_columns) {
  return hit_columns.barycentrics || needs_normals(hit_columns) ||
         SurfaceColours::needed(hit_columns);
}

bool may_store_planes(const Scene& scene) {
  std::size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) triangles += mesh.triangles.size();
  return triangles <= kMaxStoredPlanes;
}

std::vector<TrianglePlane> compute_planes(const Mesh& mesh, ThreadPool& thread_pool) {
  constexpr std::size_t kTrianglesPerTask = 4096;
  std::vector<TrianglePlane> planes(mesh.triangles.size());
  thread_pool.parallel_for(planes.size(), kTrianglesPerTask,
                           [&](std::size_t begin, std::size_t end) {
                             for (std::size_t t = begin; t < end; ++t)
                               planes[t] = plane_of(mesh, static_cast<std::uint32_t>(t));
                           });
  return planes;
}

}  // namespace

bool has_mask(const Scene& scene, const Instance& instance) {
  return std::any_of(instance.materials.begin(), instance.materials.end(),
                     [&](std::uint32_t m) { return scene.materials[m].alpha_cutoff > 0.0F; });
}

Resolver::Resolver(const Scene& scene)
    : scene_(scene),
      kernel_(select_block_kernel()),
      may_store_planes_(may_store_planes(scene)),
      colours_(scene) {
  for (const Mesh& mesh : scene.meshes) {
    first_coincident_.push_back(find_first_coincident(mesh));
    distinct_.push_back(distinct_triangles(mesh, first_coincident_.back()));
  }
  for (const Instance& instance : scene.instances) {
    if (has_mask(scene, instance)) distinct_[instance.mesh].clear();  // masks of copies may differ
  }
  instances_.reserve(scene.instances.size());
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const std::vector<std::uint32_t>& first_coincident = first_coincident_[instance.mesh];
    // With alpha masks, coincident triangles may differ in transparency.
    const bool has_duplicates = !first_coincident.empty() && !has_mask(scene, instance);
    instances_.push_back(
        {.mesh = &mesh,
         .triangles = mesh.triangles.data(),
         .positions_m = mesh.positions_m.data(),
         .normals = mesh.normals.empty() ? nullptr : mesh.normals.data(),
         .first_coincident = has_duplicates ? first_coincident.data() : nullptr,
         .has_normal_map = std::any_of(instance.materials.begin(), instance.materials.end(),
                                       [&](std::uint32_t material) {
                                         return has_normal_map(scene.materials[material], mesh);
                                       }),
         .is_masked = has_mask(scene, instance)});
    has_normal_maps_ = has_normal_maps_ || instances_.back().has_normal_map;
  }
}

void Resolver::set_poses(const Pose& world_from_sensor, std::span<const Pose> world_from_instance) {
  uses_planes_ = false;
  views_.resize(scene_.instances.size());
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const Instance& instance = scene_.instances[i];
    const Pose& pose =
        world_from_instance.empty() ? instance.world_from_object : world_from_instance[i];
    views_[i] = view_of(instance, scene_.meshes[instance.mesh], pose, world_from_sensor);
  }
}

void Resolver::use_stored_planes(const HitColumnMask& hit_columns, ThreadPool& thread_pool) {
  uses_planes_ = may_store_planes_ && !needs_corners(hit_columns);
  if (!uses_planes_) return;
  if (!planes_.empty()) return;
  for (const Mesh& mesh : scene_.meshes) planes_.push_back(compute_planes(mesh, thread_pool));
}

/// Positions of the first corners only: most others are the first ones of neighbours, or near them.
void Resolver::prefetch_corners(const HitBlock& block, const HitColumnMask& hit_columns) const {
  if (uses_planes_ && !needs_corners(hit_columns)) return;
  const bool with_normals = needs_normals(hit_columns);
  const std::uint32_t lowest = block.mask & (~block.mask + 1U);
  for_lanes(block.is_one_triangle ? lowest : block.mask, [&](unsigned i) {
    const InstanceData& of = instances_[block.instance[i]];
    const Triangle& triangle = of.triangles[block.primitive[i]];
    __builtin_prefetch(of.positions_m + triangle[0]);
    if (with_normals && of.normals != nullptr) __builtin_prefetch(of.normals + triangle[0]);
  });
}

void Resolver::gather_corners(const HitBlock& block, ExactHits& exact) const {
  if (exact.has_corners) return;
  exact.has_corners = true;
  if (is_one_instance(block)) {
    const InstanceData& of = instances_[block.instance[0]];
    kernel_.gather(gather_from(of.positions_m, of.triangles, block), exact.corners);
    return;
  }
  for (unsigned i = 0; i < kLanes; ++i) {
    const InstanceData& of = instances_[block.instance[i]];
    set_corners(i, of.positions_m, of.triangles[block.primitive[i]], exact.corners);
  }
}

/// Sets the triangles of lanes of any instances.
void Resolver::set_triangles(const HitBlock& block, ExactHits& exact) const {
  exact.has_corners = false;
  if (uses_planes_) {
    for (unsigned i = 0; i < kLanes; ++i) {
      const TrianglePlane& plane = planes_of(block.instance[i])[block.primitive[i]];
      exact.normal.set(i, plane.normal);
      exact.offset[i] = plane.offset;
    }
    return;
  }
  gather_corners(block, exact);
  kernel_.find_planes(exact.corners, exact.normal, exact.offset);
}

void Resolver::intersect(const BeamBlock& beams, HitBlock& block, ExactHits& exact) const {
  const auto first = static_cast<unsigned>(std::countr_zero(block.mask));
  for_lanes(~block.mask & kAllLanes, [&](unsigned i) {
    block.instance[i] = block.instance[first];
    block.primitive[i] = block.primitive[first];
  });
  if (!beams.has_origins && is_one_instance(block)) {
    const InstanceView& view = views_[block.instance[0]];
    const InstanceData& of = instances_[block.instance[0]];
    exact.has_corners = !uses_planes_;
    const bool is_certain =
        kernel_.intersect({.object_from_sensor = view.object_from_sensor.data(),
                           .sensor_in_object = view.sensor_in_object.data(),
                           .direction = &beams.direction,
                           .positions = gather_from(of.positions_m, of.triangles, block),
                           .is_one_triangle = block.is_one_triangle,
                           .planes = uses_planes_ ? planes_of(block.instance[0]) : nullptr},
                          {.corners = &exact.corners,
                           .normal = &exact.normal,
                           .origin = &exact.origin,
                           .direction = &exact.direction,
                           .offset = &exact.offset,
                           .cosine = &exact.cosine,
                           .distance = &exact.distance});
    if (!is_certain) intersect_grazing(*this, block, exact);
    return;
  }
  set_triangles(block, exact);
  intersect_triangles(beams, block, exact);
}

void Resolver::intersect_triangles(const BeamBlock& beams, const HitBlock& block,
                                   ExactHits& exact) const {
  rays_in(views_[block.instance[0]], beams, exact.origin, exact.direction);
  ExactHits source;
  for (std::uint32_t rest = lanes_not_on(block, block.instance[0]); rest != 0;) {
    const std::uint32_t instance = block.instance[static_cast<unsigned>(std::countr_zero(rest))];
    rays_in(views_[instance], beams, source.origin, source.direction);
    copy_rays(block, instance, source, exact);
    rest &= lanes_not_on(block, instance);
  }
  intersect_planes(exact);
  intersect_grazing(*this, block, exact);
}

void Resolver::write_diffuse_behind(const Beams& beams, std::size_t count, HitBatch& batch,
                                    Hits& hits) const {
  HitBlock& block = batch.block;
  Lanes<float> w1;
  Lanes<float> w2;
  set_triangles(block, batch.exact);
  gather_corners(block, batch.exact);
  batch.beams.has_origins = !beams.origins_m.empty();
  for (std::size_t k = 0; k < count; ++k) {
    for (unsigned i = 0; i < kLanes; ++i) {
      const std::size_t beam = ++block.beam[i];
      batch.beams.direction.set(i, beams.directions[beam]);
      if (batch.beams.has_origins) batch.beams.origin_m.set(i, beams.origins_m[beam]);
    }
    intersect_triangles(batch.beams, block, batch.exact);
    interpolate_weights(batch.exact, batch.exact.corners, w1, w2);
    colours_.write({.diffuse = true}, block, w1, w2, hits);
  }
}

void Resolver::write_ranges(const HitBlock& block, const ExactHits& exact, Hits& hits) const {
  if (is_one_instance(block)) {
    const double scale = views_[block.instance[0]].scale;
    write_lanes(
        block, block.mask, [&](unsigned i) { return exact.distance[i] * scale; }, hits.range_m);
  } else {
    const auto range_m = [&](unsigned i) {
      return exact.distance[i] * views_[block.instance[i]].scale;
    };
    write_lanes(block, block.mask, range_m, hits.range_m);
  }
  const auto instance = [&](unsigned i) { return block.instance[i]; };
  const auto primitive = [&](unsigned i) { return block.primitive[i]; };
  write_lanes(block, block.mask, instance, hits.instance);
  write_lanes(block, block.mask, primitive, hits.primitive);
}

void Resolver::write(const Beams& beams, const HitColumnMask& hit_columns, const HitBlock& block,
                     const ExactHits& exact, Hits& hits) const {
  assert(are_hits_of_rule(*this, block, exact) &&
         "a renderer was sure of a hit that the rule refuses");
  write_ranges(block, exact, hits);
  const bool has_more = hit_columns.incidence || hit_columns.depth || hit_columns.object_point;
  for_lanes(has_more ? block.mask : 0, [&](unsigned i) {
    const std::size_t beam = block.beam[i];
    if (hit_columns.incidence)
      hits.cos_incidence[beam] = static_cast<float>(std::abs(exact.cosine[i]));
    if (hit_columns.depth) hits.depth_m[beam] = depth_m(beams, beam, hits.range_m[beam]);
    if (!hit_columns.object_point) return;
    const Eigen::Vector3d point =
        mesh(block.instance[i]).origin_m +
        (exact.origin.get(i) + exact.distance[i] * exact.direction.get(i));
    hits.object_point_m[beam] =
        point.cwiseQuotient(scene_.sources[scene_.instances[block.instance[i]].mesh].stretch);
  });
  if (hit_columns.normal) write_directions(block, exact.normal, exact.cosine, hits.normal);
  if (needs_corners(hit_columns)) write_surface(hit_columns, block, exact, hits);
}

void Resolver::write_batch(const Beams& beams, const HitColumnMask& hit_columns, HitBatch& batch,
                           Hits& hits) const {
  if (batch.block.mask == 0) return;
  intersect(batch.beams, batch.block, batch.exact);
  write(beams, hit_columns, batch.block, batch.exact, hits);
}

void Resolver::write_directions(const HitBlock& block, const Lanes3<double>& front,
                                const Lanes<double>& cosine,
                                std::vector<Eigen::Vector3f>& column) const {
  if (is_one_instance(block)) {
    const Eigen::Matrix3d sensor_from_object =
        views_[block.instance[0]].object_from_sensor.transpose();
    if (block.is_run && block.mask == kAllLanes) {
      kernel_.orient(sensor_from_object.data(), front, cosine, column[block.beam[0]].data());
      return;
    }
    std::array<Eigen::Vector3f, kLanes> in_sensor;
    kernel_.orient(sensor_from_object.data(), front, cosine, in_sensor[0].data());
    for_lanes(block.mask, [&](unsigned i) { column[block.beam[i]] = in_sensor[i]; });
    return;
  }
  for_lanes(block.mask, [&](unsigned i) {
    const Eigen::Matrix3d sensor_from_object =
        views_[block.instance[i]].object_from_sensor.transpose();
    const Eigen::Vector3d in_sensor = rotate(sensor_from_object, front.get(i));
    column[block.beam[i]] = (cosine[i] > 0.0 ? -in_sensor : in_sensor).cast<float>();
  });
}

void Resolver::gather_normals(const HitBlock& block, CornerBlock& normals) const {
  // Zero normals have no length, so the flat normal is used.
  static const Eigen::Vector3f kNone = Eigen::Vector3f::Zero();
  if (is_one_instance(block)) {
    const InstanceData& of = instances_[block.instance[0]];
    if (of.normals == nullptr) {
      normals = {};
      return;
    }
    kernel_.gather(gather_from(of.normals, of.triangles, block), normals);
    return;
  }
  for (unsigned i = 0; i < kLanes; ++i) {
    const InstanceData& of = instances_[block.instance[i]];
    if (of.normals == nullptr) {
      set_corners(i, &kNone, Triangle{}, normals);
    } else {
      set_corners(i, of.normals, of.triangles[block.primitive[i]], normals);
    }
  }
}

void Resolver::write_shading(const HitColumnMask& hit_columns, const HitBlock& block,
                             const ExactHits& exact, const Weights& weights, Hits& hits) const {
  Lanes3<double> smooth;
  blend_normals(weights.normals, weights.w1, weights.w2, exact.normal, smooth);
  apply_normal_maps(block, weights.w1, weights.w2, smooth);
  if (hit_columns.shading) {
    Lanes<float> cosine;
    cosines(exact, smooth, cosine);
    const auto value = [&](unsigned i) { return cosine[i]; };
    write_lanes(block, block.mask, value, hits.cos_shading);
  }
  if (hit_columns.shading_normal)
    write_directions(block, smooth, exact.cosine, hits.shading_normal);
}

void Resolver::write_surface(const HitColumnMask& hit_columns, const HitBlock& block,
                             const ExactHits& exact, Hits& hits) const {
  Lanes<float> w1;
  Lanes<float> w2;
  interpolate_weights(exact, exact.corners, w1, w2);
  if (hit_columns.barycentrics) {
    for_lanes(block.mask, [&](unsigned i) { hits.barycentrics[block.beam[i]] = {w1[i], w2[i]}; });
  }
  if (needs_normals(hit_columns)) {
    CornerBlock normals;
    gather_normals(block, normals);
    write_shading(hit_columns, block, exact, {w1, w2, normals}, hits);
  }
  if (SurfaceColours::needed(hit_columns)) colours_.write(hit_columns, block, w1, w2, hits);
}

SurfacePoint Resolver::surface_point_at(const HitBlock& block, unsigned lane,
                                        const Lanes<float>& w1, const Lanes<float>& w2) const {
  return {mesh(block.instance[lane]), scene_.instances[block.instance[lane]], block.primitive[lane],
          Eigen::Vector2f(w1[lane], w2[lane])};
}

void Resolver::apply_normal_maps(const HitBlock& block, const Lanes<float>& w1,
                                 const Lanes<float>& w2, Lanes3<double>& normals) const {
  if (!has_normal_maps_) return;
  for_lanes(block.mask, [&](unsigned i) {
    if (!instances_[block.instance[i]].has_normal_map) return;
    const SurfacePoint surface_point = surface_point_at(block, i, w1, w2);
    if (!has_normal_map(material_at(scene_, surface_point), surface_point.mesh)) return;
    const Eigen::Vector3f smooth = normals.get(i).cast<float>();
    normals.set(i, apply_normal_map(scene_, surface_point, smooth).cast<double>());
  });
}

}  // namespace glidar
