// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>
#include <glidar/core/raw_images.hpp>
#include <glidar/math/random.hpp>
#include <glidar/math/thread_pool.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// Power of projectors, W, and irradiance, W/m²: so that numbers of electrons are finite.
inline constexpr NumberRule kLightPowerRule = {0.0, 1e6, false, "a number from 0 to 1e6"};

class FieldVisitor;

/// Light other than the projector's, within the passband of the camera.
struct AmbientLight {
  double ambient_w_per_m2 = 0.03;  ///< irradiance of every surface, from all sides
  double sun_w_per_m2 = 0.0;       ///< irradiance of a surface that faces the sun
  /// Towards the sun in the world frame, of any length.
  Eigen::Vector3d sun_direction = Eigen::Vector3d::UnitZ();
};

/// Keys of `illumination` of depth cameras.
void describe(AmbientLight& light, FieldVisitor& visitor);

/// Exposure time and gain of an imager.
struct Exposure {
  double time_s = 0.0;
  double gain = 1.0;
};

/// Automatic exposure: mean grey of the left image without noise, as a share of the greatest level.
/// First the time grows, then the gain.
struct AutoExposure {
  double target = 0.21;
  double max_time_s = 0.033;
  double max_gain = 15.5;
};

/// An infrared imager behind a lens. Both imagers of a stereo camera are alike.
struct Imager {
  double focal_length_m = 0.00193;  ///< pixels are square, focal length over fx
  double f_number = 2.0;
  double quantum_efficiency = 0.3;  ///< electrons per photon at the lens: with its transmission
  double blur_px = 0.5;             ///< standard deviation of the lens's Gaussian point spread
  double full_well_e = 8000.0;      ///< electrons that a pixel holds; the greatest level at gain 1
  double read_noise_e = 10.0;       ///< standard deviation, electrons
  std::uint32_t bits = 8;           ///< of grey levels, 8 to 16
  double exposure_s = 0.0;          ///< 0: automatic
  double gain = 1.0;                ///< with a fixed exposure
  AutoExposure auto_exposure;
};

/// Keys of `imager` of depth cameras.
void describe(AutoExposure& exposure, FieldVisitor& visitor);
void describe(Imager& imager, FieldVisitor& visitor);

/// Electrons per second that each pixel of an image receives on average. N = width * height.
struct ElectronRates {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<float> projector;  ///< N, from light of the projector
  std::vector<float> ambient;    ///< N, from all other light
};

/// Electrons per second in a pixel on the axis for a radiance of 1 W / (m^2 sr): the irradiance
/// behind a lens is pi L / (4 f_number^2) (Smith, Modern Optical Engineering, "camera equation"),
/// times the area of the pixel and the efficiency, divided by the energy h c / wavelength of a
/// photon. Off the axis it falls as cos^4 of the angle.
double electron_rate_per_radiance(const Imager& imager, double focal_length_px,
                                  double wavelength_m);

/// The fixed exposure, or the one that gives this image its target; the longest with the greatest
/// gain where there is too little light.
Exposure find_exposure(const Imager& imager, const ElectronRates& rates);

/// Levels of grey for each electron.
double levels_per_electron(const Imager& imager, const Exposure& exposure);

/// Light of one pixel while it is exposed.
struct PixelLight {
  double projector_e = 0.0;  ///< mean electrons
  double ambient_e = 0.0;
};

/// How a pixel got its grey level.
struct PixelReading {
  double speckle = 1.0;    ///< factor of the projector's light, of mean 1
  double electrons = 0.0;  ///< Poisson number, at most the full well
  double read_noise_e = 0.0;
  std::uint16_t level = 0;
};

/// Speckle (gamma distribution of mean 1: Goodman, Speckle phenomena in optics, 3.2, for the
/// intensity of several patterns), shot noise, full well, read noise, gain, rounding and clipping.
/// Uses the blocks of `key` from 0 on.
PixelReading read_pixel(const Imager& imager, double levels_per_electron, double speckle_contrast,
                        const PixelLight& light, RngKey key);

/// Weights of the rays around a pixel, in one direction: a Gaussian of blur_px about each of the
/// pixel's sub_rays rays, of sum 1, symmetric. Entry k belongs to ray k - radius, counted from the
/// first ray of the pixel; radius is (size - sub_rays) / 2.
std::vector<double> point_spread_weights(std::uint32_t sub_rays, double blur_px);

/// Size of an image of pixels.
struct ImageSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

/// Averages an image of sub_rays x sub_rays rays per pixel (rows from the top) to pixels, with
/// these weights along both axes. Beyond the edge the last ray is repeated. Sums are in a fixed
/// order.
void average_rays(std::span<const float> rays, std::uint32_t sub_rays,
                  std::span<const double> weights, const ImageSize& size, ThreadPool& threads,
                  std::vector<float>& pixels);

}  // namespace glidar
