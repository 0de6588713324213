// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/embree/embree_world.hpp>

#include <glidar/core/error.hpp>
#include <glidar/render/planes.hpp>
#include <glidar/render/surface.hpp>

#include <algorithm>
#include <array>
#include <string>

namespace glidar::embree {
namespace {

void require(bool done, RTCDevice device, const char* what) {
  if (done) return;
  const RTCError code = rtcGetDeviceError(device);
  throw Error(
      {.where = "Embree",
       .found = std::string(what) + " failed (code " + std::to_string(code) + ")",
       .allowed = "",
       .remedy = code == RTC_ERROR_OUT_OF_MEMORY ? "memory ran out: use a smaller model" : ""});
}

/// True when the beam comes to the triangle from behind.
bool seen_from_behind(const FilterContext& context, std::uint32_t beam, std::uint32_t instance,
                      std::uint32_t primitive) {
  const Eigen::Vector3d direction =
      context.resolver->view(instance).object_from_sensor * context.beams->directions[beam];
  return context.resolver->plane(instance, primitive).normal.dot(direction) > 0.0;
}

/// Takes away hits on culled back faces and on cut-out texels, lane by lane.
void filter(const RTCFilterFunctionNArguments* args) {
  const auto* context = reinterpret_cast<const FilterContext*>(args->context);
  const Scene& scene = context->resolver->scene();
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (args->valid[lane] == 0) continue;
    const unsigned found = RTCHitN_instID(args->hit, args->N, lane, 0);
    const std::uint32_t instance = found == RTC_INVALID_GEOMETRY_ID ? 0 : found;
    const std::uint32_t primitive = RTCHitN_primID(args->hit, args->N, lane);
    const std::uint32_t beam = RTCRayN_id(args->ray, args->N, lane);
    if (context->cull_back_faces && seen_from_behind(*context, beam, instance, primitive)) {
      args->valid[lane] = 0;
      continue;
    }
    const Eigen::Vector2f weights(RTCHitN_u(args->hit, args->N, lane),
                                  RTCHitN_v(args->hit, args->N, lane));
    const SurfacePlace place{context->resolver->mesh(instance), scene.instances[instance],
                             primitive, weights};
    if (is_cut_out(scene, place)) args->valid[lane] = 0;
  }
}

/// True when an instance of the mesh has a material with an alpha mask.
bool is_masked(const Scene& scene, std::size_t mesh) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    return instance.mesh == mesh && has_mask(scene, instance);
  });
}

/// trace_from_object as Embree takes it: 3x4, column by column.
std::array<float, 12> embree_transform(const Instance& instance, const Mesh& mesh, const Pose& pose,
                                       const Eigen::Vector3d& trace_origin) {
  const Eigen::Matrix3d linear = pose.linear() * instance.scale;
  const Eigen::Vector3d shift = (pose.translation() - trace_origin) + linear * mesh.origin_m;
  std::array<float, 12> numbers{};
  Eigen::Map<Eigen::Matrix<float, 3, 4>> matrix(numbers.data());
  matrix << linear.cast<float>(), shift.cast<float>();
  return numbers;
}

const Pose& pose_of(const Scene& scene, const CastRequest& request, std::size_t instance) {
  return request.world_from_instance.empty() ? scene.instances[instance].world_from_object
                                             : request.world_from_instance[instance];
}

}  // namespace

World::World(const Scene& scene) : scene_(scene), device_(rtcNewDevice(nullptr)) {
  require(device_ != nullptr, nullptr, "starting");
  require(rtcGetDeviceProperty(device_.get(), RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED) != 0,
          device_.get(), "looking for filter functions");
  has_wide_packets_ =
      rtcGetDeviceProperty(device_.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    add_mesh(scene.meshes[i], is_masked(scene, i));
    narrowness_.push_back(triangle_narrowness(scene.meshes[i]));
  }
  for (const Instance& instance : scene.instances) {
    narrowness_of_.push_back(narrowness_[instance.mesh].data());
  }
  if (scene.instances.size() != 1) add_instances();
}

void World::add_mesh(const Mesh& mesh, bool filtered) {
  OwnedScene owned(rtcNewScene(device_.get()));
  // Without ROBUST, rays slip between triangles that share an edge.
  rtcSetSceneFlags(owned.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(owned.get(), RTC_BUILD_QUALITY_MEDIUM);
  const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  give_vertices(mesh, geometry);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.triangles.data(), 0, sizeof(Triangle), mesh.triangles.size());
  if (filtered) rtcSetGeometryIntersectFilterFunction(geometry, filter);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(owned.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(owned.get());
  require(rtcGetDeviceError(device_.get()) == RTC_ERROR_NONE, device_.get(), "building a mesh");
  mesh_scenes_.push_back(std::move(owned));
  mesh_boxes_.push_back(bounds(mesh));
}

/// Embree reads 16 bytes of the last vertex: shared when there is room behind it, else copied.
void World::give_vertices(const Mesh& mesh, RTCGeometry geometry) const {
  const std::vector<Eigen::Vector3f>& positions = mesh.positions_m;
  if (positions.capacity() > positions.size()) {
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               positions.data(), 0, sizeof(Eigen::Vector3f), positions.size());
    return;
  }
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(Eigen::Vector3f), positions.size());
  if (positions.empty()) return;
  require(vertices != nullptr, device_.get(), "storing vertices");
  std::copy(positions.begin(), positions.end(), static_cast<Eigen::Vector3f*>(vertices));
}

void World::add_instances() {
  top_scene_.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(top_scene_.get(), RTC_SCENE_FLAG_ROBUST);
  for (const Instance& instance : scene_.instances) {
    const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, mesh_scenes_[instance.mesh].get());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(top_scene_.get(), geometry);  // ids count up from 0, as instances do
    rtcReleaseGeometry(geometry);
  }
}

void World::filter_everything() {
  if (filters_everything_) return;
  filters_everything_ = true;
  for (const OwnedScene& mesh_scene : mesh_scenes_) {
    const RTCGeometry geometry = rtcGetGeometry(mesh_scene.get(), 0);
    rtcSetGeometryIntersectFilterFunction(geometry, filter);
    rtcCommitGeometry(geometry);
    rtcCommitScene(mesh_scene.get());
  }
  placed_.clear();  // the instances must be committed again over the changed trees
}

void World::place(const CastRequest& request) {
  if (scene_.instances.size() == 1) {
    place_single(request.world_from_sensor, pose_of(scene_, request, 0));
  } else {
    place_many(request);
  }
}

void World::place_single(const Pose& world_from_sensor, const Pose& world_from_object) {
  const Instance& instance = scene_.instances[0];
  const Mesh& mesh = scene_.meshes[instance.mesh];
  const InstanceView view = view_of(instance, mesh, world_from_object, world_from_sensor);
  const Eigen::AlignedBox3d& box = mesh_boxes_[instance.mesh];
  const bool empty = box.isEmpty();
  const double radius = empty ? 0.0 : 0.5 * box.diagonal().norm();
  space_ = {
      .scene = mesh_scenes_[instance.mesh].get(),
      .trace_from_sensor = view.object_from_sensor,
      .sensor_in_trace = view.sensor_in_object,
      .metres_per_unit = instance.scale,
      .centre = empty ? Eigen::Vector3d::Zero() : Eigen::Vector3d(box.center() - mesh.origin_m),
      .radius = radius,
      .least_reach = radius};
  reach_.assign(1, radius);
}

void World::place_many(const CastRequest& request) {
  Eigen::AlignedBox3d all;
  for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
    const Instance& instance = scene_.instances[i];
    const Eigen::AlignedBox3d& box = mesh_boxes_[instance.mesh];
    if (box.isEmpty() || !is_present(request, i)) continue;
    const double reach = instance.scale * 0.5 * box.diagonal().norm();
    const Eigen::Vector3d middle = pose_of(scene_, request, i) * (instance.scale * box.center());
    all.extend(Eigen::AlignedBox3d(middle.array() - reach, middle.array() + reach));
  }
  const Eigen::Vector3d sensor = request.world_from_sensor.translation();
  // The point of the scene next to the sensor: what is near it keeps the most digits.
  const Eigen::Vector3d origin =
      all.isEmpty() ? sensor : Eigen::Vector3d(sensor.cwiseMax(all.min()).cwiseMin(all.max()));
  bool changed = placed_.size() != scene_.instances.size() || origin != trace_origin_;
  trace_origin_ = origin;
  for (std::size_t i = 0; i < placed_.size() && !changed; ++i) {
    changed = placed_[i].matrix() != pose_of(scene_, request, i).matrix() ||
              (present_[i] != 0) != is_present(request, i);
  }
  if (changed) commit_instances(request);
  const bool empty = all.isEmpty();
  const double radius = empty ? 0.0 : 0.5 * all.diagonal().norm();
  space_ = {.scene = top_scene_.get(),
            .trace_from_sensor = request.world_from_sensor.linear(),
            .sensor_in_trace = sensor - origin,
            .metres_per_unit = 1.0,
            .centre = empty ? Eigen::Vector3d::Zero() : Eigen::Vector3d(all.center() - origin),
            .radius = radius,
            .least_reach = radius};
  reach_.assign(scene_.instances.size(), radius);
  for (std::size_t i = 0; i < reach_.size(); ++i) {
    const Eigen::AlignedBox3d& box = mesh_boxes_[scene_.instances[i].mesh];
    if (box.isEmpty() || !is_present(request, i)) continue;
    const double scale = scene_.instances[i].scale;
    const Eigen::Vector3d middle = pose_of(scene_, request, i) * (scale * box.center());
    reach_[i] = std::min(radius, (middle - origin).norm() + scale * 0.5 * box.diagonal().norm());
    space_.least_reach = std::min(space_.least_reach, reach_[i]);
  }
}

void World::commit_instances(const CastRequest& request) {
  placed_.resize(scene_.instances.size());
  present_.resize(scene_.instances.size());
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const Instance& instance = scene_.instances[i];
    placed_[i] = pose_of(scene_, request, i);
    present_[i] = static_cast<std::uint8_t>(is_present(request, i));
    const std::array<float, 12> transform =
        embree_transform(instance, scene_.meshes[instance.mesh], placed_[i], trace_origin_);
    const RTCGeometry geometry = rtcGetGeometry(top_scene_.get(), static_cast<unsigned>(i));
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform.data());
    if (present_[i] != 0) {
      rtcEnableGeometry(geometry);
    } else {
      rtcDisableGeometry(geometry);
    }
    rtcCommitGeometry(geometry);
  }
  rtcCommitScene(top_scene_.get());
  require(rtcGetDeviceError(device_.get()) == RTC_ERROR_NONE, device_.get(), "placing instances");
}

}  // namespace glidar::embree
