// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/surface_reflectance.hpp>

#include <glidar/sensor/lidar/lidar_equation.hpp>

#include <algorithm>

namespace glidar {

void SurfaceReflectance::select(const Hits& hits, std::size_t beam) {
  const std::uint32_t hit = hits.instance[beam];
  if (hit == instance_) return;
  const Instance& instance = scene_.instances[hit];
  material_ = &material_of(scene_, instance, hits.primitive[beam]);
  plain_ = luminance(material_->diffuse);
  reflectance_ = reflectance_at(*material_, wavelength_m_);
  instance_ = scene_.meshes[instance.mesh].material_slots.empty() ? hit : kInvalidId;
}

HitSurface SurfaceReflectance::at(const Hits& hits, std::size_t beam) {
  select(hits, beam);
  const float diffuse = hits.diffuse[beam];
  HitSurface surface{.brdf = &material_->backscatter, .opacity = material_->opacity};
  if (material_->spectrum.empty()) {
    surface.reflectance = diffuse;
  } else {  // scaled as the texture and the vertex colours scale the diffuse colour
    surface.reflectance = reflectance_ * (plain_ > 0.0F ? std::min(1.0F, diffuse / plain_) : 1.0);
  }
  return surface;
}

}  // namespace glidar
