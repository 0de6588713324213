// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/infrared_image.hpp>

#include <glidar/simulate/infrared_shadows.hpp>

namespace glidar {
namespace {

constexpr HitColumnMask kShadedColumns = {.shading_normal = true, .diffuse = true};
constexpr std::size_t kPixelsPerTask = 4096;

/// The sensor's pose when the image is taken.
Pose sensor_pose(const Simulation& s, std::uint32_t time_ns) {
  if (!s.is_moving) return s.frame.world_from_sensor;
  return pose_at(s.motion.world_from_sensor, s.frame.stamp_ns + time_ns);
}

InfraredLights lights_of(const Simulation& s, const InfraredView& view) {
  const AmbientLight& light = view.imager.setup.illumination;
  const Eigen::Matrix3d rotation = sensor_pose(s, view.time_ns).linear();
  return {.projector = view.projector,
          .projector_m = view.projector_m - view.eye_m,
          .sun_direction = (rotation.transpose() * light.sun_direction).normalized(),
          .sun_w_per_m2 = light.sun_w_per_m2,
          .ambient_w_per_m2 = light.ambient_w_per_m2};
}

/// Shades a tile of rays without shadows.
void shade(const Simulation& s, const PreparedImager& imager, const InfraredLights& lights,
           BeamRange tile) {
  InfraredWorkspace& memory = s.workspace.infrared;
  const Hits& hits = memory.hits;
  SurfaceReflectance surfaces(s.scene, imager.wavelength_m);
  const auto background = static_cast<float>(background_radiance(lights));
  for (std::size_t i = tile.begin; i < tile.end; ++i) {
    memory.projector[i] = 0.0F;
    memory.ambient[i] = background;
    if (!memory.sun.empty()) memory.sun[i] = 0.0F;
    if (hits.instance[i] == kInvalidId) continue;
    const InfraredRadiance radiance =
        infrared_radiance(lights, {.position_m = hits.range_m[i] * imager.rays.directions[i],
                                   .normal = hits.shading_normal[i].cast<double>(),
                                   .surface = surfaces.at(hits, i)});
    memory.projector[i] = static_cast<float>(radiance.projector);
    memory.ambient[i] = static_cast<float>(radiance.ambient);
    if (!memory.sun.empty()) memory.sun[i] = static_cast<float>(radiance.sun);
  }
}

/// The rays of an image; where something moves, at its time.
const Beams& timed_rays(const Simulation& s, const InfraredView& view) {
  if (!s.is_moving) return view.imager.rays;
  Beams& rays = s.workspace.infrared.timed_rays;
  if (rays.size() != view.imager.rays.size()) rays = view.imager.rays;
  rays.times_ns.assign(rays.size(), view.time_ns);
  return rays;
}

void cast_rays(const Simulation& s, const InfraredView& view, const Pose& world_from_eye,
               const InfraredLights& lights) {
  InfraredWorkspace& memory = s.workspace.infrared;
  const std::size_t count = view.imager.rays.size();
  memory.projector.resize(count);
  memory.ambient.resize(count);
  memory.sun.resize(lights.sun_w_per_m2 > 0.0 ? count : 0);
  const auto shade_tile = [&](BeamRange tile) { shade(s, view.imager, lights, tile); };
  CastRequest request = cast_request(s, timed_rays(s, view), kShadedColumns);
  request.world_from_sensor = world_from_eye;
  request.on_tile_done = FunctionRef<void(BeamRange)>(shade_tile);
  cast(s, request, memory.hits);
}

/// Adds the sun's light to that from all sides.
void add_sun(InfraredWorkspace& memory, ThreadPool& threads) {
  threads.parallel_for(memory.sun.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) memory.ambient[i] += memory.sun[i];
  });
}

/// Radiance towards the camera of the surface that each ray meets.
void find_radiance(const Simulation& s, const InfraredView& view) {
  InfraredWorkspace& memory = s.workspace.infrared;
  const Pose world_from_eye = s.frame.world_from_sensor * Eigen::Translation3d(view.eye_m);
  const InfraredLights lights = lights_of(s, view);
  cast_rays(s, view, world_from_eye, lights);
  const ShadowView shadow_view{view.imager, world_from_eye, view.time_ns};
  remove_shadows(s, shadow_view, {.origin_m = lights.projector_m}, memory.projector);
  if (memory.sun.empty()) return;
  remove_shadows(s, shadow_view, {.sun_direction = lights.sun_direction}, memory.sun);
  add_sun(memory, s.renderer.thread_pool());
}

}  // namespace

void find_electron_rates(const Simulation& s, const PreparedImager& imager,
                         std::span<const float> radiance, std::vector<float>& per_s) {
  ThreadPool& threads = s.renderer.thread_pool();
  average_rays(radiance, imager.setup.sub_rays, imager.weights, imager.size, threads, per_s);
  const auto scale = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double z = s.beams.directions[i].z();
      const double cosine = z > 0.0 ? z : 0.0;  // not for NaN
      const double rate = imager.electron_rate * (cosine * cosine) * (cosine * cosine);
      per_s[i] = static_cast<float>(rate * per_s[i]);
    }
  };
  threads.parallel_for(per_s.size(), kPixelsPerTask, scale);
}

void render_infrared(const Simulation& s, const InfraredView& view, ElectronRates& rates) {
  InfraredWorkspace& memory = s.workspace.infrared;
  find_radiance(s, view);
  rates.width = view.imager.size.width;
  rates.height = view.imager.size.height;
  find_electron_rates(s, view.imager, memory.projector, rates.projector);
  find_electron_rates(s, view.imager, memory.ambient, rates.ambient);
}

}  // namespace glidar
