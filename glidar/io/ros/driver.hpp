// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>
#include <glidar/io/ros/cloud_message.hpp>
#include <glidar/io/ros/message_types.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::ros {

// Names of topics and frames below may contain %, for which the name of the sensor is put.

/// What an image shows, and its pixels.
enum class ImageContent : std::uint8_t {
  depth_16uc1,
  depth_32fc1,
  intensity_mono8,
  intensity_mono16,
  intensity_32fc1,
  range_32fc1,
  colour_rgb8,
  colour_bgra8,
  infrared_left,   ///< of the raw images
  infrared_right,  ///< the same
  ouster_range,
  ouster_signal,
  ouster_reflectivity,
  ouster_near_infrared,
};

/// A stream of images with its CameraInfo.
struct ImageStream {
  ImageContent content = ImageContent::depth_32fc1;
  std::string_view topic;
  std::string_view frame;
  std::string_view info_topic = {};  ///< empty: none
  std::string_view info_frame = {};  ///< empty: that of the image
};

/// A transform that the driver publishes itself.
struct StaticFrame {
  std::string_view parent;
  std::string_view child;
  Pose (*parent_from_child)(const Sensor& sensor) = nullptr;
  bool of_right_camera = false;  ///< only with a right infrared image
};

/// How a driver publishes its IMU.
struct ImuFormat {
  std::string_view topic = {};
  std::string_view frame = {};
  double acceleration_unit_m_s2 = 1.0;
  double rate_unit_rad_s = 1.0;
  bool has_optical_axes = false;  ///< x right, y down, z forward
  std::array<double, 4> orientation_xyzw = {0.0, 0.0, 0.0, 1.0};
  std::array<double, 9> orientation_covariance = {-1.0};
  std::optional<double> rate_variance = {};          ///< empty: from the noise density
  std::optional<double> acceleration_variance = {};  ///< the same
  Qos qos = {.depth = 200};
};

/// How scans are made.
enum class ScanKind : std::uint8_t { none, ring, velodyne, ouster, rplidar };

/// The sensors that a driver can publish.
enum class DriverSensors : std::uint8_t { scanners, spinning, planar, cameras };

/// What a driver of ROS publishes of a sensor.
struct Driver {
  std::string_view name = {};     ///< of --as; empty: GLIDAR's own topics
  std::string_view package = {};  ///< for help
  DriverSensors sensors = DriverSensors::scanners;
  std::string_view frame = {};  ///< of clouds and scans
  int quarter_turns = 0;        ///< of its axes, see quarter_turned(), besides those of the layout
  std::string_view cloud_topic = {};      ///< empty: none
  std::vector<std::string> columns = {};  ///< of clouds without a layout; empty: the user's
  CloudMessageOptions cloud = {};
  ScanKind scan = ScanKind::none;
  std::string_view scan_topic = {};
  Qos qos = {};  ///< of clouds, scans and images
  std::span<const ImageStream> images = {};
  std::optional<ImuFormat> imu = {};
  std::span<const StaticFrame> frames = {};  ///< the first parent is fixed to the rig
  std::string_view packet_topic = {};        ///< before the names of packet topics
  bool has_packets = false;                  ///< also without --packet-topics
};

/// The drivers of manufacturers.
std::span<const Driver> drivers();

/// Throws Error naming all drivers and the nearest when there is none of this name.
const Driver& find_driver(std::string_view name);

/// GLIDAR's own topics for a sensor, which suit all consumers that are known.
const Driver& own_driver(const Sensor& sensor);

/// Whether a driver can publish a sensor.
bool suits(const Driver& driver, const Sensor& sensor, const Beams& beams);

/// The sensors that it can publish, for errors.
std::string driver_sensors_text(const Driver& driver);

/// Whether the sensor takes infrared images of a stereo pair, and the distance between its
/// cameras.
bool has_infrared(const Sensor& sensor);
double stereo_baseline_m(const Sensor& sensor);

}  // namespace glidar::ros
