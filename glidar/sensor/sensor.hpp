// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/core/phong_headlight.hpp>
#include <glidar/depth_camera/depth_camera.hpp>
#include <glidar/sensor/lidar/doppler.hpp>
#include <glidar/sensor/lidar/echo.hpp>
#include <glidar/sensor/lidar/footprint.hpp>
#include <glidar/sensor/lidar/lidar_equation.hpp>
#include <glidar/sensor/lidar/weather.hpp>
#include <glidar/sensor/noise/noise.hpp>
#include <glidar/sensor/optics/line_scan.hpp>
#include <glidar/sensor/optics/pinhole.hpp>
#include <glidar/sensor/optics/ray_table.hpp>
#include <glidar/sensor/optics/rotating_optics.hpp>
#include <glidar/sensor/optics/spinning.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace glidar {

class FieldVisitor;
class ThreadPool;

/// The distances that the sensor reports. A surface outside them still blocks the beam. They are
/// applied twice: to surfaces, and to what noise makes of their distances.
struct Limits {
  enum class Along : std::uint8_t { depth, range };
  double near_m = 0.0;  ///< 0: no limit, so depths below 0 (views wider than 180 degrees) count too
  double far_m = std::numeric_limits<double>::infinity();
  Along along = Along::depth;  ///< the limits apply to depth (boresight) or range (beam)
};

/// Keys of `limits` in sensor files.
void describe(Limits& limits, FieldVisitor& visitor);

/// The status of a surface at this range on a beam: hit, too_near or too_far.
Status check_limits(const Limits& limits, const Beams& beams, std::size_t beam, double range_m);

/// Ranges and statuses of a tile of beams from the ranges of the ground truth.
void classify_surfaces(const Limits& limits, const Beams& beams, BeamRange tile, Frame& frame);

/// Removes the returns whose measured distance is outside the limits. `beams` are the nominal
/// beams, without pointing noise, along which the sensor reports.
void remove_returns_outside(const Limits& limits, const Beams& beams, ThreadPool& thread_pool,
                            Frame& frame);

/// A measured depth or range within the limits in whole units of an output: the nearest number, or
/// its neighbour where the nearest is outside the limits.
double to_whole_units(const Limits& limits, Limits::Along along, double distance_m, double unit_m);

/// Throws Error unless the attenuation coefficients are finite, non-negative and not all zero.
void validate(const PhongHeadlight& light);

/// Fills a range of frame.intensity from frame.ground_truth by equations (3) to (5) of the 2016
/// paper with h of (2), for beams whose status is hit; 0 elsewhere. Requires cos_shading and
/// reflectance in frame.ground_truth.
void shade_phong(const PhongHeadlight& light, BeamRange range, Frame& frame);

class FieldVisitor;

using Optics = std::variant<Pinhole, Spinning, LineScan, Prism, WedgeMirror, RayTable>;

/// A 3D sensor, as plain numbers.
struct Sensor {
  std::string name = "depth camera";
  Optics optics = Pinhole{};
  double rate_hz = 30.0;      ///< frames per second; see set_rate
  double wavelength_m = 0.0;  ///< of the light; 0: unknown
  Limits limits;
  PhongHeadlight light;                         ///< Phong model of the 2016 paper
  std::optional<LidarEquation> lidar_equation;  ///< set: a pulsed sensor; replaces `light`
  std::optional<Footprint> footprint;           ///< of pulses; empty: the beam is a line
  std::optional<Weather> weather;               ///< empty: clear air; affects `lidar_equation`
  Receiver receiver;                            ///< of pulses
  std::optional<Doppler> doppler;               ///< empty: it measures no radial velocity
  /// Position of the light source in the sensor frame: surfaces that it does not see are occluded.
  /// Empty: the sensor's origin.
  std::optional<Eigen::Vector3d> projector_origin_m;
  std::vector<NoiseStep> noise;  ///< applied in this order, by DepthModel::law
  DepthModel depth_model = DepthModel::law;
  std::optional<DepthCamera> depth_camera;  ///< what DepthModel::physical simulates
  bool cull_back_faces = false;             ///< true: beams pass through the backs of triangles
  std::vector<std::string> files = {};      ///< the files that define it
  std::vector<std::string> notes = {};      ///< defaults and numbers of its files to mention
  std::string variant = {};                 ///< of a family of sensors in a file; empty: none
  std::string mode = {};                    ///< of the file, such as "1024x10"; empty: none
};

/// Selects how a depth camera is simulated. Throws Error naming `where` for DepthModel::physical
/// when the sensor has no depth_camera.
void set_depth_model(DepthModel model, const std::string& where, Sensor& sensor);

/// What is simulated from raw images: the depth_camera of DepthModel::physical, or null.
const DepthCamera* physical_camera(const Sensor& sensor);

/// Throws Error unless the optics and the wavelength fit the depth camera, or there is none: a
/// pinhole, light of a known wavelength, for stereo no distortion and an image wider than the
/// matcher's search, and not too many rays.
void check_depth_camera(const Sensor& sensor);

/// The sensor without noise, lidar equation, weather, footprint, further returns and projector: it
/// reports the geometric ground truth with the intensity of the Phong model. Its limits stay, and
/// it reports true radial velocities if it measures any.
Sensor ground_truth_sensor(Sensor sensor);

/// Sets the frame rate, and with it the rotation rate of a spinning sensor and the scan rate of a
/// line scanner. Throws Error unless it is in [1e-6, 1e9].
void set_rate(Sensor& sensor, double rate_hz);

/// Throws Error for weather without a lidar equation, and for fog without a wavelength.
void check_weather(const Sensor& sensor);

/// Throws Error if the sensor measures radial velocities without a limit, but has false alarms,
/// which are uniform up to that limit.
void check_doppler(const Sensor& sensor);

/// Throws Error if the columns of a cloud contain radial_velocity, which the sensor does not
/// measure. All columns together are valid for every sensor; this one is NaN then.
void check_columns(const Sensor& sensor, std::span<const std::string> column_names);

/// The number of channels: rings of clouds are below it.
std::size_t channel_count(const Optics& optics);

/// Throws Error unless the sensor has one of lidar_equation.channel_range_m for each channel, or
/// none.
void check_channel_ranges(const Sensor& sensor);

/// The interval of a frame at the sensor's rate. Frames join without gap or overlap.
FrameInterval frame_interval(const Sensor& sensor, std::uint32_t frame);

/// The beams that the sensor emits in an interval, in the sensor frame; times count from the start
/// of the interval. Every beam is repeated for each return of the receiver.
Beams make_beams(const Sensor& sensor, const FrameInterval& interval);

/// The same for frame 0.
Beams make_beams(const Sensor& sensor);

/// A sensor that does not change, with the beams of its first and its latest frame and those in
/// use.
class BeamCache {
 public:
  explicit BeamCache(Sensor sensor);
  /// The same with the beams of frame 0, where they are known.
  BeamCache(Sensor sensor, Beams first);

  [[nodiscard]] const Sensor& sensor() const { return sensor_; }
  /// The beams of a frame; all frames of a camera share theirs. May be called from any thread.
  [[nodiscard]] std::shared_ptr<const Beams> beams(std::uint32_t frame = 0) const;

 private:
  Sensor sensor_;
  std::shared_ptr<const Beams> first_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Beams> latest_;
  mutable std::map<std::uint32_t, std::weak_ptr<const Beams>> in_use_;  ///< by frame
};

}  // namespace glidar
