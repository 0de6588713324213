// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/lidar/echo.hpp>
#include <glidar/sensor/lidar/footprint.hpp>
#include <glidar/sensor/lidar/lidar_equation.hpp>
#include <glidar/sensor/lidar/weather.hpp>
#include <glidar/sensor/noise/noise.hpp>
#include <glidar/sensor/optics/line_scan.hpp>
#include <glidar/sensor/optics/pinhole.hpp>
#include <glidar/sensor/optics/prism.hpp>
#include <glidar/sensor/optics/ray_table.hpp>
#include <glidar/sensor/optics/spinning.hpp>
#include <glidar/sensor/phong_shading.hpp>

#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace glidar {

using Optics = std::variant<Pinhole, Spinning, LineScan, Prism, RayTable>;

/// What the sensor can report. A surface outside still blocks the beam.
struct Limits {
  enum class Along : std::uint8_t { depth, range };
  double near_m = 0.0;  ///< 0: none, so that what lies behind a camera of wide view counts too
  double far_m = std::numeric_limits<double>::infinity();
  Along along = Along::depth;  ///< what the limits are about: along the boresight or the beam
};

/// A 3D sensor, as plain numbers.
struct Sensor {
  std::string name = "depth camera";
  Optics optics = Pinhole{};
  double rate_hz = 30.0;      ///< frames per second; see set_rate
  double wavelength_m = 0.0;  ///< of the light; 0: not known
  Limits limits;
  PhongHeadlight light;                ///< the paper's
  std::optional<LidarEquation> pulse;  ///< the range equation in its place
  std::optional<Footprint> footprint;  ///< of pulses; empty: a line
  std::optional<Weather> weather;      ///< empty: clear air; acts on `pulse`
  Receiver receiver;                   ///< of pulses
  /// Where its light comes from, in its frame: what that place does not see is occluded. Empty:
  /// from where it looks.
  std::optional<Eigen::Vector3d> projector_origin_m;
  std::vector<NoiseStep> noise;         ///< in the order in which the sensor makes its errors
  bool cull_back_faces = false;         ///< true: triangles seen from behind let the beam through
  std::vector<std::string> files = {};  ///< that it was read from
};

/// What the sensor says of something at this true range on a beam: hit, too_near or too_far.
Status check_limits(const Limits& limits, const Beams& beams, std::size_t beam, double range_m);

/// The sensor without noise, pulse light, weather, footprint, further returns and a projector apart
/// from it: it reports the geometric truth, lit by the paper's lamp. Its limits stay.
Sensor ground_truth_sensor(Sensor sensor);

/// Sets the frame rate, and with it what follows from it: the turns per second of a spinning sensor
/// and the scans per second of a raster. Throws Error unless it is within 1e-6
/// to 1e9.
void set_rate(Sensor& sensor, double rate_hz);

/// Throws Error when there is weather but no pulsed light for it to act on, or fog and no
/// wavelength.
void check_weather(const Sensor& sensor);

/// The window of a frame, by the sensor's own rate. Frames join.
FrameInterval frame_interval(const Sensor& sensor, std::uint32_t frame);

/// What the sensor emits in a window, in its own frame; times count from the window's start. Every
/// beam stands there once for each return of the receiver.
Beams make_beams(const Sensor& sensor, const FrameInterval& window);

/// The same for the first window.
Beams make_beams(const Sensor& sensor);

}  // namespace glidar
