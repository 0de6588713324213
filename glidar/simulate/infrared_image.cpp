// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/infrared_image.hpp>

#include <glidar/sensor/depth_camera/point_spread.hpp>
#include <glidar/simulate/infrared_shading.hpp>
#include <glidar/simulate/infrared_shadows.hpp>

namespace glidar {
namespace {

constexpr HitColumnMask kShadedColumns = {.shading_normal = true, .diffuse = true};
constexpr std::size_t kPixelsPerTask = 4096;

InfraredLights lights_of(const Simulation& s, const PreparedActiveStereo& prepared,
                         const Eigen::Vector3d& origin_m) {
  const AmbientLight& light = prepared.camera.illumination;
  return {.pattern = prepared.pattern,
          .projector_m = prepared.camera.projector.origin_m - origin_m,
          .sun_direction =
              (s.frame.world_from_sensor.linear().transpose() * light.sun_direction).normalized(),
          .sun_w_per_m2 = light.sun_w_per_m2,
          .ambient_w_per_m2 = light.ambient_w_per_m2};
}

/// Shades a tile of rays without shadows.
void shade(const Simulation& s, const PreparedActiveStereo& prepared, const InfraredLights& lights,
           BeamRange tile) {
  InfraredWorkspace& memory = s.workspace.infrared;
  const Hits& hits = memory.hits;
  SurfaceReflectance surfaces(s.scene, prepared.wavelength_m);
  const auto background = static_cast<float>(background_radiance(lights));
  for (std::size_t i = tile.begin; i < tile.end; ++i) {
    memory.projector[i] = 0.0F;
    memory.ambient[i] = background;
    if (!memory.sun.empty()) memory.sun[i] = 0.0F;
    if (hits.instance[i] == kInvalidId) continue;
    const InfraredRadiance radiance =
        infrared_radiance(lights, {.position_m = hits.range_m[i] * prepared.rays.directions[i],
                                   .normal = hits.shading_normal[i].cast<double>(),
                                   .surface = surfaces.at(hits, i)});
    memory.projector[i] = static_cast<float>(radiance.projector);
    memory.ambient[i] = static_cast<float>(radiance.ambient);
    if (!memory.sun.empty()) memory.sun[i] = static_cast<float>(radiance.sun);
  }
}

void cast_rays(const Simulation& s, const PreparedActiveStereo& prepared,
               const Pose& world_from_eye, const InfraredLights& lights) {
  InfraredWorkspace& memory = s.workspace.infrared;
  const std::size_t count = prepared.rays.size();
  memory.projector.resize(count);
  memory.ambient.resize(count);
  memory.sun.resize(lights.sun_w_per_m2 > 0.0 ? count : 0);
  const auto shade_tile = [&](BeamRange tile) { shade(s, prepared, lights, tile); };
  CastRequest request = cast_request(s, prepared.rays, kShadedColumns);
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

/// From mean radiances to electrons per second.
void scale_to_electrons(const Simulation& s, const PreparedActiveStereo& prepared,
                        ElectronRates& rates) {
  const auto scale = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double cosine = s.beams.directions[i].z();
      const double rate = prepared.electron_rate * (cosine * cosine) * (cosine * cosine);
      rates.projector[i] = static_cast<float>(rate * rates.projector[i]);
      rates.ambient[i] = static_cast<float>(rate * rates.ambient[i]);
    }
  };
  s.renderer.thread_pool().parallel_for(s.beams.size(), kPixelsPerTask, scale);
}

}  // namespace

void render_infrared(const Simulation& s, const PreparedActiveStereo& prepared,
                     const Eigen::Vector3d& origin_m, ElectronRates& rates) {
  InfraredWorkspace& memory = s.workspace.infrared;
  ThreadPool& threads = s.renderer.thread_pool();
  const Pose world_from_eye = s.frame.world_from_sensor * Eigen::Translation3d(origin_m);
  const InfraredLights lights = lights_of(s, prepared, origin_m);
  cast_rays(s, prepared, world_from_eye, lights);
  const ShadowView view{prepared, world_from_eye};
  remove_shadows(s, view, {.origin_m = lights.projector_m}, memory.projector);
  if (!memory.sun.empty()) {
    remove_shadows(s, view, {.sun_direction = lights.sun_direction}, memory.sun);
    add_sun(memory, threads);
  }
  const ImageSize size{prepared.intrinsics.width, prepared.intrinsics.height};
  rates.width = size.width;
  rates.height = size.height;
  const std::uint32_t sub_rays = prepared.camera.sub_rays;
  average_rays(memory.projector, sub_rays, prepared.weights, size, threads, rates.projector);
  average_rays(memory.ambient, sub_rays, prepared.weights, size, threads, rates.ambient);
  scale_to_electrons(s, prepared, rates);
}

}  // namespace glidar
