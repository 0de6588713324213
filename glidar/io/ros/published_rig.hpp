// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/io/ros/cloud_message.hpp>
#include <glidar/io/ros/codec.hpp>
#include <glidar/motion/motion.hpp>
#include <glidar/sensor/imu.hpp>
#include <glidar/sensor/sensor.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::ros {

/// How the images of cameras are published.
enum class ImageTransport : std::uint8_t {
  raw,         ///< depth as Image
  compressed,  ///< depth and intensity as CompressedImage
  both,
};

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

/// Names of coordinate frames: REP-105.
inline constexpr const char* kMapFrame = "map";
inline constexpr const char* kOdometryFrame = "odom";
inline constexpr const char* kRigFrame = "base_link";
/// The frame of the ground truth, which is that of the scene.
inline constexpr const char* kGroundTruthFrame = "ground_truth";

/// How the poses of the rig are published.
enum class TransformMode : std::uint8_t {
  /// /tf has ground_truth as a child of base_link, so that base_link can have another parent, and
  /// /ground_truth/odom has the pose of base_link in ground_truth.
  ground_truth,
  odom,  ///< /tf: odom to base_link; odom is the start, level. /odom: the same (REP-105)
  map,   ///< /tf: map to base_link; /odom: the same
  none,  ///< neither these nor the transforms of sensors
};

struct TransformOptions {
  TransformMode mode = TransformMode::ground_truth;
  std::string prefix = {};  ///< of the names of all frames but map
};

/// The packets of a sensor, which are published beside its clouds.
struct PublishedPackets {
  PacketOptions options;
  PacketImuSampler imu_samples;
};

/// A sensor whose frames are published. Sensor and beams must outlive the publisher.
struct PublishedSensor {
  std::string name;  ///< on the rig; empty: the only sensor
  const Sensor& sensor;
  const Beams& beams;  ///< of frame 0
  Pose rig_from_sensor = Pose::Identity();
  std::optional<PublishedPackets> packets = {};
};

/// An IMU whose samples are published.
struct PublishedImu {
  std::string name;
  Pose rig_from_imu = Pose::Identity();
  glidar::Imu imu = {};  ///< its errors, for covariances
};

/// The samples of an IMU, by index, with from_ns <= t < until_ns.
using ImuSampler =
    std::function<ImuSamples(std::size_t imu, std::int64_t from_ns, std::int64_t until_ns)>;

/// What is published. The scene must outlive the publisher.
struct PublishedRig {
  const Scene& scene;
  std::vector<PublishedSensor> sensors;
  /// The motion of the rig; empty: known only at the times of frames, by the frames' poses.
  std::optional<Trajectory> world_from_rig = {};
  std::vector<PublishedImu> imus = {};  ///< only with world_from_rig
  ImuSampler imu_samples = {};
};

}  // namespace glidar::ros
