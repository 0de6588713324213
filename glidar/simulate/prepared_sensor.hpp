// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/hits.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/depth_camera/imager.hpp>
#include <glidar/sensor/lidar/weather_echoes.hpp>
#include <glidar/sensor/optics/pinhole.hpp>
#include <glidar/sensor/sensor.hpp>
#include <glidar/simulate/prepared_tof.hpp>

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

namespace glidar {

/// What the images of a depth camera are taken with.
struct ImagerSetup {
  const Imager& imager;
  const AmbientLight& illumination;
  std::uint32_t sub_rays = 1;  ///< each pixel is the mean of sub_rays x sub_rays rays
};

/// The images of a depth camera with everything that is the same for all frames.
struct PreparedImager {
  ImagerSetup setup;
  ImageSize size;
  double wavelength_m = 0.0;
  Beams rays;                   ///< sub_rays x sub_rays for each pixel, row by row
  std::vector<double> weights;  ///< of the rays around a pixel, see point_spread_weights()
  double electron_rate = 0.0;   ///< see electron_rate_per_radiance()
};

/// Of a sensor whose optics are a pinhole. Refers to what the setup refers to.
PreparedImager prepare_imager(const Sensor& sensor, const ImagerSetup& setup);

/// A structured-light camera with everything that is the same for all frames.
struct PreparedStructuredLight {
  const StructuredLightCamera& camera;
  StructuredLight setup;  ///< what decodes its images
  PreparedImager imager;
  PinholeProjection projection;           ///< of the projector
  Eigen::Vector3d projector_m;            ///< origin of the projector in the sensor frame
  double white_w_per_sr = 0.0;            ///< see white_intensity_w_per_sr()
  std::vector<std::vector<float>> lines;  ///< of each pattern, see projected_line()
};

PreparedStructuredLight prepare_structured_light(const StructuredLightCamera& camera,
                                                 const Sensor& sensor);

/// The pixel of the projector, whole numbers are centres, that lights what is at the end of a path
/// from it (in the sensor's axes); empty: none does.
std::optional<Eigen::Vector2d> projector_pixel(const PreparedStructuredLight& prepared,
                                               const Eigen::Vector3d& path);

/// An active stereo camera with everything that is the same for all frames.
struct PreparedActiveStereo {
  const ActiveStereo& camera;
  PreparedImager imager;
  double focal_length_px = 0.0;  ///< along x
  IntensityMap pattern;
  std::vector<float> pattern_view;  ///< Reference::pattern: the pattern as the second camera
};

PreparedActiveStereo prepare_active_stereo(const ActiveStereo& camera, const Sensor& sensor);

/// True when a beam of this sensor is more than one ray with one return: it has a footprint,
/// reports several returns or another than the strongest, has range walk, or meets mirrors or
/// weather.
bool needs_waveform(const Sensor& sensor, bool has_mirrors);

/// The footprint and attenuation of a sensor's pulses.
struct PulseModel {
  std::vector<SubRay> sub_rays;            ///< of each beam; without a footprint a single one
  std::optional<PreparedWeather> weather;  ///< empty: clear air
  LidarEquation lidar_equation;            ///< with the weather's extinction
  bool has_mirrors = false;                ///< whether the sensor may see mirrors
  /// Whether footprints on flat triangles are integrated, see FlatFootprints: their sub-rays differ
  /// only by a power of the range and the angle of incidence.
  bool has_closed_form = false;
};

/// A depth camera that is simulated from its raw images.
using PreparedDepthCamera =
    std::variant<PreparedActiveStereo, PreparedTof, PreparedStructuredLight>;

/// A sensor with everything about it that is the same for all frames of a scene.
struct PreparedSensor {
  const Sensor& sensor;
  NoisePlan noise;                        ///< without steps for a depth camera
  HitColumnMask required_hit_columns;     ///< ground truth that signal, occlusion and noise read
  std::optional<PulseModel> pulse_model;  ///< set when needs_waveform()
  std::optional<PreparedDepthCamera> depth_camera;  ///< set for DepthModel::physical
};

/// Throws Error when the sensor's weather, radial velocities or depth camera need what the sensor
/// lacks, see check_weather(), check_doppler() and check_depth_camera(). Refers to the sensor.
PreparedSensor prepare_sensor(const Sensor& sensor, bool has_mirrors);

}  // namespace glidar
