// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/function_ref.hpp>
#include <glidar/sensor/lidar/surface_reflectance.hpp>
#include <glidar/simulate/simulation.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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
struct LitPoint {
  Eigen::Vector3d position_m;  ///< in the frame of the camera
  Eigen::Vector3d normal;      ///< of length 1
  HitSurface surface;
};

/// Radiance of a point of a surface towards the origin. With the irradiance E of a surface that
/// faces the source, at the incidence t, E cos t f / pi: f is the reflectance of a diffuse surface;
/// other surfaces have their monostatic backscatter (core/material.hpp) divided by its cosine, both
/// at the normal's angle from the bisector of the directions to source and camera, so that source
/// and camera in one place see the backscatter itself. E of the projector is its intensity /
/// distance^2. Ambient light comes evenly from all sides. Radiance is proportional to the
/// surface's opacity: light that passes through it does not return.
InfraredRadiance infrared_radiance(const InfraredLights& lights, const LitPoint& point);

/// Radiance where no surface is: that of the surroundings that cause the ambient irradiance.
double background_radiance(const InfraredLights& lights);

/// A camera with the sensor's optics and axes, and its projector.
struct InfraredView {
  const PreparedImager& imager;
  ProjectorIntensity projector;
  Eigen::Vector3d projector_m;                      ///< its origin, in the sensor frame
  Eigen::Vector3d eye_m = Eigen::Vector3d::Zero();  ///< that of the camera
  std::uint32_t time_ns = 0;                        ///< since the start of the frame
};

/// Casts the rays of an image and their shadows. Electrons per second of each pixel by the
/// projector's light and by all other light; the radiances of the rays are in
/// Simulation::workspace.
void render_infrared(const Simulation& s, const InfraredView& view, ElectronRates& rates);

/// Electrons per second of each pixel for a radiance of each ray: point spread, and the fall of the
/// light with cos^4 of the angle from the axis. 0 for pixels without a ray.
void find_electron_rates(const Simulation& s, const PreparedImager& imager,
                         std::span<const float> radiance, std::vector<float>& per_s);

/// An image that an imager takes, and its random numbers.
struct ImageExposure {
  const Imager& imager;
  Exposure exposure;
  double speckle_contrast = 0.0;
  Purpose purpose = Purpose::left_image;
  std::size_t number = 0;  ///< of the image among those of one purpose
};

/// Mean electrons of a pixel.
PixelLight light_of(const ElectronRates& rates, const Exposure& exposure, std::size_t pixel);

/// How a pixel of the image gets its grey level.
PixelReading read_pixel(const Simulation& s, const ElectronRates& rates, const ImageExposure& taken,
                        std::size_t pixel);

/// The image as the imager reports it, without a name.
RawImage read_image(const Simulation& s, const ElectronRates& rates, const ImageExposure& taken);

}  // namespace glidar
