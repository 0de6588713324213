// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/infrared_shading.hpp>

#include <glidar/sensor/lidar/lidar_equation.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace glidar {
namespace {

/// Reflectance for light from all sides: that of the diffuse part of a surface.
double diffuse_reflectance(const HitSurface& surface) {
  if (const auto* phong = std::get_if<PhongLike>(surface.brdf)) {
    return (1.0 - phong->specular_fraction) * surface.reflectance;
  }
  if (const auto* glossy = std::get_if<Glossy>(surface.brdf)) {
    return glossy->diffuse_fraction * surface.reflectance;
  }
  return std::holds_alternative<RetroReflector>(*surface.brdf) ? 0.0 : surface.reflectance;
}

/// f for light from `to_light`, of length 1, that a surface sends to `to_camera`.
double reflection(const SurfacePoint& point, const Eigen::Vector3d& to_light,
                  const Eigen::Vector3d& to_camera) {
  const HitSurface& surface = point.surface;
  if (std::holds_alternative<Lambert>(*surface.brdf)) return surface.reflectance;
  const double cosine = point.normal.dot((to_light + to_camera).normalized());
  if (!(cosine > 0.0)) return 0.0;
  return backscatter(*surface.brdf, surface.reflectance, std::min(cosine, 1.0)) / cosine;
}

double projector_radiance(const InfraredLights& lights, const SurfacePoint& point,
                          const Eigen::Vector3d& to_camera) {
  const Eigen::Vector3d path = point.position_m - lights.projector_m;
  const double intensity = lights.projector(path);
  if (intensity == 0.0) return 0.0;
  const double square = path.squaredNorm();
  const Eigen::Vector3d to_light = -path / std::sqrt(square);
  const double cosine = point.normal.dot(to_light);
  if (!(cosine > 0.0)) return 0.0;
  return intensity / square * cosine * reflection(point, to_light, to_camera);
}

double sun_radiance(const InfraredLights& lights, const SurfacePoint& point,
                    const Eigen::Vector3d& to_camera) {
  const double cosine = point.normal.dot(lights.sun_direction);
  if (!(lights.sun_w_per_m2 > 0.0 && cosine > 0.0)) return 0.0;
  return lights.sun_w_per_m2 * cosine * reflection(point, lights.sun_direction, to_camera);
}

}  // namespace

InfraredRadiance infrared_radiance(const InfraredLights& lights, const SurfacePoint& point) {
  const Eigen::Vector3d to_camera = -point.position_m.normalized();
  const double share = point.surface.opacity * std::numbers::inv_pi;
  return {.projector = share * projector_radiance(lights, point, to_camera),
          .sun = share * sun_radiance(lights, point, to_camera),
          .ambient = share * lights.ambient_w_per_m2 * diffuse_reflectance(point.surface)};
}

double background_radiance(const InfraredLights& lights) {
  return lights.ambient_w_per_m2 * std::numbers::inv_pi;
}

}  // namespace glidar
