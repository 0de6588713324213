// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/tof_light.hpp>

#include <glidar/sensor/lidar/surface_reflectance.hpp>
#include <glidar/sensor/optics/sub_pixels.hpp>
#include <glidar/simulate/tof_bounces.hpp>

#include <algorithm>

namespace glidar {
namespace {

constexpr HitColumnMask kTofColumns = {.shading_normal = true, .shading = true, .diffuse = true};

/// Casts the rays of all pixels at the time of an exposure.
void cast_rays(const Simulation& s, const PreparedTof& prepared, const TofExposure& exposure) {
  TofWorkspace& memory = s.workspace.tof;
  if (!s.is_moving) {
    return cast(s, cast_request(s, prepared.rays, kTofColumns), memory.hits);
  }
  if (memory.rays.size() != prepared.rays.size()) memory.rays = prepared.rays;
  memory.rays.times_ns.assign(memory.rays.size(), exposure.time_ns);
  cast(s, cast_request(s, memory.rays, kTofColumns), memory.hits);
}

/// Adds the light of one ray to its pixel; returns the share of light that the surface reflects.
double add_ray(const PreparedTof& prepared, const TofExposure& exposure,
               SurfaceReflectance& surfaces, const Hits& hits, std::size_t ray,
               std::span<TofLight> of_steps) {
  if (hits.instance[ray] == kInvalidId) return 0.0;
  const TofCamera& camera = prepared.camera;
  const HitSurface surface = surfaces.at(hits, ray);
  const double range_m = hits.range_m[ray];
  const double cosine = std::clamp(double{hits.cos_shading[ray]}, 0.0, 1.0);
  const double share = double{surface.opacity} / (camera.sub_rays * camera.sub_rays);
  const double returned = backscatter(*surface.brdf, surface.reflectance, cosine);
  const double reflected = share * std::min(1.0, surface.reflectance);
  const TofLight light{.signal = share * camera.signal_electrons * returned / (range_m * range_m),
                       .background = camera.ambient_electrons * reflected};
  add_light(prepared.steps, exposure, light, range_m, of_steps);
  return reflected;
}

/// Adds the light of a pixel's sub-rays to its steps. Returns the reflectance seen, from 0 to 1.
double add_pixel(const Simulation& s, const PreparedTof& prepared, const TofExposure& exposure,
                 SurfaceReflectance& surfaces, std::size_t pixel) {
  TofWorkspace& memory = s.workspace.tof;
  const std::size_t n = prepared.camera.sub_rays;
  const std::size_t steps = step_count(prepared);
  const std::span<TofLight> of_steps(&memory.light[pixel * steps], steps);
  double reflectance = 0.0;
  for (std::size_t i = 0; i < n * n; ++i) {
    const std::size_t ray = ray_of_pixel(s.beams.cols, n, pixel, i);
    reflectance += add_ray(prepared, exposure, surfaces, memory.hits, ray, of_steps);
  }
  return reflectance;
}

void add_direct_light(const Simulation& s, const PreparedTof& prepared,
                      const TofExposure& exposure) {
  const std::size_t columns = s.beams.cols;
  const auto add_rows = [&](std::size_t begin, std::size_t end) {
    SurfaceReflectance surfaces(s.scene, prepared.wavelength_m);
    for (std::size_t pixel = begin * columns; pixel < end * columns; ++pixel) {
      s.workspace.tof.reflectance[pixel] = add_pixel(s, prepared, exposure, surfaces, pixel);
    }
  };
  s.renderer.thread_pool().parallel_for(s.beams.rows, 1, add_rows);
}

/// One for all steps where nothing moves, otherwise one for each.
std::vector<TofExposure> list_exposures(const Simulation& s, const PreparedTof& prepared) {
  const std::size_t steps = step_count(prepared);
  if (!s.is_moving) return {{0, steps, 0}};
  std::vector<TofExposure> exposures;
  for (std::size_t i = 0; i < steps; ++i) {
    exposures.push_back({i, i + 1, exposure_time_ns(i, prepared.camera.step_interval_s)});
  }
  return exposures;
}

}  // namespace

void add_light(const TofSteps& steps, const TofExposure& exposure, const TofLight& light,
               double range_m, std::span<TofLight> of_steps) {
  for (std::size_t i = exposure.first; i < exposure.end; ++i) {
    of_steps[i].background += light.background;
  }
  if (exposure.end - exposure.first == of_steps.size()) {
    return add_light(steps, range_m, light.signal, of_steps);
  }
  for (std::size_t i = exposure.first; i < exposure.end; ++i) {
    add_light(steps, range_m, light.signal, i, of_steps[i]);
  }
}

void find_tof_light(const Simulation& s, const PreparedTof& prepared) {
  TofWorkspace& memory = s.workspace.tof;
  memory.light.assign(s.beams.size() * step_count(prepared),
                      {.background = prepared.camera.dark_electrons});
  memory.reflectance.resize(s.beams.size());
  memory.bounced.assign(s.beams.size(), 0.0F);
  Simulation timed = s;
  timed.is_moving = prepared.camera.step_interval_s > 0.0 && moves(s.motion);
  for (const TofExposure& exposure : list_exposures(timed, prepared)) {
    cast_rays(timed, prepared, exposure);
    add_direct_light(timed, prepared, exposure);
    if (prepared.camera.bounces > 0) add_bounces(timed, prepared, exposure);
  }
}

}  // namespace glidar
