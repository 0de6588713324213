// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/function_ref.hpp>
#include <glidar/sensor/lidar/surface_reflectance.hpp>

#include <Eigen/Core>

namespace glidar {

/// Radiant intensity of a projector along a path from it, in the frame of the camera, W/sr.
using ProjectorIntensity = FunctionRef<double(const Eigen::Vector3d& path)>;

/// The light sources of a scene in the frame of a camera.
struct InfraredLights {
  ProjectorIntensity projector;
  Eigen::Vector3d projector_m;    ///< its origin
  Eigen::Vector3d sun_direction;  ///< towards the sun, of length 1
  double sun_w_per_m2 = 0.0;
  double ambient_w_per_m2 = 0.0;
};

/// Radiance of a surface towards the camera by light source, W / (m^2 sr), all of them visible.
struct InfraredRadiance {
  double projector = 0.0;
  double sun = 0.0;
  double ambient = 0.0;
};

/// A point of a surface.
struct SurfacePoint {
  Eigen::Vector3d position_m;  ///< in the frame of the camera
  Eigen::Vector3d normal;      ///< of length 1
  HitSurface surface;
};

/// Radiance of a point of a surface towards the origin. With the irradiance E of a surface that
/// faces the source, at the incidence t, E cos t f / pi: f is the reflectance of a diffuse surface;
/// other surfaces have their monostatic backscatter (core/brdf.hpp) divided by its cosine, both at
/// the normal's angle from the bisector of the directions to source and camera, so that source and
/// camera in one place see the backscatter itself. E of the projector is its intensity /
/// distance^2. Ambient light comes evenly from all sides. Radiance is proportional to the
/// surface's opacity: light that passes through it does not return.
InfraredRadiance infrared_radiance(const InfraredLights& lights, const SurfacePoint& point);

/// Radiance where no surface is: that of the surroundings that cause the ambient irradiance.
double background_radiance(const InfraredLights& lights);

}  // namespace glidar
