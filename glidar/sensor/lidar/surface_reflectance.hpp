// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/hits.hpp>
#include <glidar/core/scene.hpp>

#include <cstddef>
#include <cstdint>

namespace glidar {

/// How a surface reflects where a beam hit it.
struct HitSurface {
  const Brdf* brdf = nullptr;
  double reflectance = 0.0;
  float opacity = 1.0F;  ///< of the material
};

/// Looks up surfaces of hits at one wavelength. Neighbours mostly hit the same instance, whose
/// material is looked up once.
class SurfaceReflectance {
 public:
  SurfaceReflectance(const Scene& scene, double wavelength_m)
      : scene_(scene), wavelength_m_(wavelength_m) {}

  /// The surface of a hit; it is not a miss. Requires the column `diffuse`.
  HitSurface at(const Hits& hits, std::size_t beam);

 private:
  void select(const Hits& hits, std::size_t beam);

  const Scene& scene_;
  double wavelength_m_;
  std::uint32_t instance_ = kInvalidId;  ///< of material_, if it has one material
  const Material* material_ = nullptr;
  float plain_ = 0.0F;  ///< luminance of the diffuse colour
  double reflectance_ = 0.0;
};

}  // namespace glidar
