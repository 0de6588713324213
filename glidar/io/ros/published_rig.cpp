// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/published_rig.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/sensor/imu.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <variant>

namespace glidar::ros {
namespace {

constexpr Qos kSensorData = {.reliable = false, .depth = 5};  // rclcpp::SensorDataQoS

Pose same(const Sensor& /*sensor*/) {
  return Pose::Identity();
}

/// RPY -90, 0, -90 degrees: REP-103, "Suffix Frames".
Pose body_from_optical(const Sensor& /*sensor*/) {
  return optical_from_body().inverse();
}

Pose shifted_mm(double x, double y, double z) {
  Pose pose = Pose::Identity();
  pose.translation() = 1e-3 * Eigen::Vector3d(x, y, z);
  return pose;
}

/// The right camera is beside the left one: along -y of the body, along x of the optical frame.
Pose left_from_right(const Sensor& sensor) {
  return shifted_mm(0.0, -1e3 * stereo_baseline_m(sensor), 0.0);
}

Pose left_optical_from_right(const Sensor& sensor) {
  return shifted_mm(1e3 * stereo_baseline_m(sensor), 0.0, 0.0);
}

/// ouster-sdk (46b7bce), default_lidar_to_sensor_transform: turned by 180 degrees, 36.18 mm up.
Pose os_sensor_from_lidar(const Sensor& /*sensor*/) {
  return shifted_mm(0.0, 0.0, 36.18) * quarter_turned(2);
}

/// ouster-sdk, default_imu_to_sensor_transform.
Pose os_sensor_from_imu(const Sensor& /*sensor*/) {
  return shifted_mm(6.253, -11.775, 7.645);
}

/// The depth camera is pitched down by 6 degrees, 1.8 mm up: k4a_calibration_transform_data.cpp.
Pose base_from_depth_camera(const Sensor& sensor) {
  constexpr double kPitchTurns = 6.0 / 360.0;
  const SineCosine pitch = sincos_turns(kPitchTurns);
  Pose pitched = shifted_mm(0.0, 0.0, 1.8);
  pitched.linear() << pitch.cosine, 0.0, pitch.sine, 0.0, 1.0, 0.0, -pitch.sine, 0.0, pitch.cosine;
  return pitched * body_from_optical(sensor);
}

// The streams of GLIDAR's own topics and of the cameras' drivers.

constexpr std::array<ImageStream, 5> kOwnImages = {{
    {ImageContent::depth_32fc1, "/%/depth/image_raw", "%_depth_optical_frame",
     "/%/depth/camera_info"},
    {ImageContent::intensity_mono8, "/%/intensity/image_raw", "%_depth_optical_frame",
     "/%/intensity/camera_info"},
    {ImageContent::colour_rgb8, "/%/color/image_raw", "%_depth_optical_frame",
     "/%/color/camera_info"},
    {ImageContent::infrared_left, "/%/infra1/image_rect_raw", "%_depth_optical_frame",
     "/%/infra1/camera_info"},
    {ImageContent::infrared_right, "/%/infra2/image_rect_raw", "%_infra2_optical_frame",
     "/%/infra2/camera_info"},
}};

constexpr std::array<StaticFrame, 2> kOwnFrames = {{
    {"%_link", "%_depth_optical_frame", body_from_optical},
    {"%_depth_optical_frame", "%_infra2_optical_frame", left_optical_from_right, true},
}};

/// realsenseai/realsense-ros (775b167), base_realsense_node.cpp: the CameraInfo of infra2 names the
/// left camera's frame.
constexpr std::array<ImageStream, 5> kRealsenseImages = {{
    {ImageContent::depth_16uc1, "/camera/camera/depth/image_rect_raw", "camera_depth_optical_frame",
     "/camera/camera/depth/camera_info"},
    {ImageContent::colour_rgb8, "/camera/camera/color/image_raw", "camera_color_optical_frame",
     "/camera/camera/color/camera_info"},
    {ImageContent::infrared_left, "/camera/camera/infra1/image_rect_raw",
     "camera_infra1_optical_frame", "/camera/camera/infra1/camera_info"},
    {ImageContent::infrared_right, "/camera/camera/infra2/image_rect_raw",
     "camera_infra2_optical_frame", "/camera/camera/infra2/camera_info",
     "camera_infra1_optical_frame"},
    {ImageContent::depth_16uc1, "/camera/camera/aligned_depth_to_color/image_raw",
     "camera_color_optical_frame", "/camera/camera/aligned_depth_to_color/camera_info"},
}};

/// The same, tfs.cpp; the colour camera of GLIDAR is the depth camera.
constexpr std::array<StaticFrame, 8> kRealsenseFrames = {{
    {"camera_link", "camera_depth_frame", same},
    {"camera_depth_frame", "camera_depth_optical_frame", body_from_optical},
    {"camera_link", "camera_color_frame", same},
    {"camera_color_frame", "camera_color_optical_frame", body_from_optical},
    {"camera_link", "camera_infra1_frame", same, true},
    {"camera_infra1_frame", "camera_infra1_optical_frame", body_from_optical, true},
    {"camera_link", "camera_infra2_frame", left_from_right, true},
    {"camera_infra2_frame", "camera_infra2_optical_frame", body_from_optical, true},
}};

/// microsoft/Azure_Kinect_ROS_Driver (6ffb95a), k4a_ros_device.cpp.
constexpr std::array<ImageStream, 5> kAzureImages = {{
    {ImageContent::colour_bgra8, "/rgb/image_raw", "rgb_camera_link", "/rgb/camera_info"},
    {ImageContent::depth_16uc1, "/depth/image_raw", "depth_camera_link", "/depth/camera_info"},
    {ImageContent::depth_16uc1, "/depth_to_rgb/image_raw", "rgb_camera_link",
     "/depth_to_rgb/camera_info"},
    {ImageContent::colour_bgra8, "/rgb_to_depth/image_raw", "depth_camera_link",
     "/rgb_to_depth/camera_info"},
    {ImageContent::intensity_mono16, "/ir/image_raw", "depth_camera_link", "/ir/camera_info"},
}};

constexpr std::array<StaticFrame, 2> kAzureFrames = {{
    {"camera_base", "depth_camera_link", base_from_depth_camera},
    {"depth_camera_link", "rgb_camera_link", same},
}};

/// ouster-lidar/ouster-ros (f5c4ef8), os_static_transforms_broadcaster.h and image_processor.h.
constexpr std::array<StaticFrame, 2> kOusterFrames = {{
    {"os_sensor", "os_lidar", os_sensor_from_lidar},
    {"os_sensor", "os_imu", os_sensor_from_imu},
}};

constexpr std::array<ImageStream, 4> kOusterImages = {{
    {ImageContent::ouster_range, "/ouster/range_image", "os_lidar"},
    {ImageContent::ouster_signal, "/ouster/signal_image", "os_lidar"},
    {ImageContent::ouster_reflectivity, "/ouster/reflec_image", "os_lidar"},
    {ImageContent::ouster_near_infrared, "/ouster/nearir_image", "os_lidar"},
}};

constexpr ImuFormat kOusterImu = {
    .topic = "/ouster/imu",
    .frame = "os_imu",
    .orientation_covariance = {-1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0},
    .rate_variance = 6e-4,
    .acceleration_variance = 0.01,
    .qos = kSensorData};

/// Values of the device, without covariances; the orientation is not set.
constexpr ImuFormat kLivoxImu = {.topic = "/livox/imu",
                                 .frame = "livox_frame",
                                 .acceleration_unit_m_s2 = kStandardGravity_m_s2,
                                 .orientation_covariance = {},
                                 .rate_variance = 0.0,
                                 .acceleration_variance = 0.0,
                                 .qos = {.depth = 256}};

constexpr ImuFormat kHesaiImu = {.topic = "/lidar_imu",
                                 .frame = "hesai_lidar",
                                 .acceleration_unit_m_s2 = kStandardGravity_m_s2,
                                 .rate_unit_rad_s = kDegree,
                                 .orientation_covariance = {},
                                 .rate_variance = 0.0,
                                 .acceleration_variance = 0.0,
                                 .qos = {.depth = 20}};

constexpr ImuFormat kRobosenseImu = {.topic = "/rslidar_imu_data",
                                     .frame = "rslidar",
                                     .acceleration_unit_m_s2 = kStandardGravity_m_s2,
                                     .orientation_covariance = {},
                                     .rate_variance = 0.0,
                                     .acceleration_variance = 0.0,
                                     .qos = {.depth = 1000}};

constexpr ImuFormat kRealsenseImu = {.topic = "/camera/camera/imu",
                                     .frame = "camera_imu_optical_frame",
                                     .has_optical_axes = true,
                                     .orientation_xyzw = {0.0, 0.0, 0.0, 0.0},
                                     .rate_variance = 0.01,
                                     .acceleration_variance = 0.01,
                                     .qos = kSensorData};

constexpr ImuFormat kAzureImu = {.topic = "/imu", .frame = "imu_link", .qos = {.depth = 200}};

/// ros-drivers/velodyne (04a7ca7): driver.cpp, organized_cloudXYZIRT.cpp, config/VLP16-*.yaml.
Driver velodyne_driver() {
  return {.name = "velodyne",
          .package = "velodyne_driver, velodyne_pointcloud, velodyne_laserscan",
          .sensors = DriverSensors::spinning,
          .frame = "velodyne",
          .cloud_topic = "/velodyne_points",
          .cloud = {.layout = "velodyne",
                    .misses = Misses::nan,
                    .order = PointOrder::rings,
                    .stamp = StampRule::last_packet,
                    .is_dense = false,
                    .intensity_of_misses_nan = true,
                    .min_range_m = 0.9,
                    .max_range_m = 130.0},
          .scan = ScanKind::velodyne,
          .scan_topic = "/scan",
          .has_packets = true};
}

/// ouster-lidar/ouster-ros (f5c4ef8): os_point.h, point_cloud_compose.h, os_ros.cpp.
Driver ouster_driver() {
  return {.name = "ouster",
          .package = "ouster_ros",
          .sensors = DriverSensors::spinning,
          .frame = "os_lidar",
          .quarter_turns = 2,
          .cloud_topic = "/ouster/points",
          .cloud = {.layout = "ouster",
                    .misses = Misses::nan,
                    .order = PointOrder::destaggered,
                    .stamp = StampRule::first_firing,
                    .offsets = {0, 4, 8, 16, 20, 24, 26, 28, 32},
                    .point_step = 48},
          .scan = ScanKind::ouster,
          .scan_topic = "/ouster/scan",
          .qos = kSensorData,
          .images = kOusterImages,
          .imu = kOusterImu,
          .frames = kOusterFrames,
          .packet_topic = "/ouster"};
}

/// Livox-SDK/livox_ros_driver2 (13eb05e): lddc.cpp, pub_handler.cpp, launch_ROS2/msg_MID360_launch.
Driver livox_driver() {
  return {.name = "livox",
          .package = "livox_ros_driver2",
          .frame = "livox_frame",
          .cloud_topic = "/livox/lidar",
          .cloud = {.layout = std::string(kCustomMsgLayout),
                    .misses = Misses::zero,
                    .stamp = StampRule::first_point,
                    .is_dense = true},
          .qos = {.depth = 256},
          .imu = kLivoxImu};
}

/// HesaiTechnology/HesaiLidar_ROS_2.0 (e7e112f), source_driver_ros2.hpp; SDK (ea7f86f), udp_parser.
Driver hesai_driver() {
  return {.name = "hesai",
          .package = "hesai_ros_driver",
          .frame = "hesai_lidar",
          .cloud_topic = "/lidar_points",
          .cloud = {.layout = "hesai",
                    .misses = Misses::zero,
                    .stamp = StampRule::first_firing,
                    .packet_stamps = true,
                    .is_dense = false},
          .imu = kHesaiImu};
}

/// RoboSense-LiDAR/rslidar_sdk (78d2abb), source_pointcloud_ros.hpp; rs_driver (4eeadac).
Driver robosense_driver() {
  return {.name = "robosense",
          .package = "rslidar_sdk",
          .frame = "rslidar",
          .cloud_topic = "/rslidar_points",
          .cloud = {.layout = "robosense-xyzi",
                    .misses = Misses::nan,
                    .order = PointOrder::columns,
                    .stamp = StampRule::first_firing,
                    .is_dense = false,
                    .min_range_m = 0.2,
                    .max_range_m = 200.0},
          .qos = {.depth = 100},
          .imu = kRobosenseImu};
}

/// realsenseai/realsense-ros (775b167): base_realsense_node.cpp, pointcloud_filter.cpp.
Driver realsense_driver() {
  return {.name = "realsense",
          .package = "realsense2_camera",
          .sensors = DriverSensors::cameras,
          .frame = "camera_depth_optical_frame",
          .cloud_topic = "/camera/camera/depth/color/points",
          .columns = {"xyz", "colour"},
          .cloud = {.offsets = {0, 4, 8, 16}, .point_step = 20},
          .images = kRealsenseImages,
          .imu = kRealsenseImu,
          .frames = kRealsenseFrames};
}

/// microsoft/Azure_Kinect_ROS_Driver (6ffb95a): k4a_ros_device.cpp, driver.launch.py.
Driver azure_driver() {
  return {.name = "azure",
          .package = "azure_kinect_ros_driver",
          .sensors = DriverSensors::cameras,
          .frame = "rgb_camera_link",
          .cloud_topic = "/points2",
          .columns = {"xyz", "colour"},
          .cloud = {.misses = Misses::nan,
                    .order = PointOrder::rows,
                    .is_dense = false,
                    .offsets = {0, 4, 8, 16},
                    .point_step = 32},
          .qos = {.depth = 1},
          .images = kAzureImages,
          .imu = kAzureImu,
          .frames = kAzureFrames};
}

/// Slamtec/sllidar_ros2 (3430009): sllidar_node.cpp, launch/sllidar_a1_launch.py.
Driver rplidar_driver() {
  return {.name = "rplidar",
          .package = "sllidar_ros2",
          .sensors = DriverSensors::planar,
          .frame = "laser",
          .quarter_turns = 2,
          .scan = ScanKind::rplidar,
          .scan_topic = "/scan"};
}

const std::array<Driver, 2>& own_drivers() {
  static const std::array<Driver, 2> kOwn = {{
      {.frame = "%", .cloud_topic = "/%/points", .scan = ScanKind::ring, .scan_topic = "/%/scan"},
      {.sensors = DriverSensors::cameras,
       .frame = "%_depth_optical_frame",
       .cloud_topic = "/%/points",
       .images = kOwnImages,
       .frames = kOwnFrames},
  }};
  return kOwn;
}

bool is_pinhole(const Sensor& sensor) {
  return std::holds_alternative<Pinhole>(sensor.optics);
}

}  // namespace

std::span<const Driver> drivers() {
  static const std::array<Driver, 8> kDrivers = {
      velodyne_driver(),  ouster_driver(),    livox_driver(), hesai_driver(),
      robosense_driver(), realsense_driver(), azure_driver(), rplidar_driver()};
  return kDrivers;
}

const Driver& find_driver(std::string_view name) {
  std::vector<std::string> names;
  for (const Driver& driver : drivers()) {
    if (driver.name == name) return driver;
    names.emplace_back(driver.name);
  }
  const std::string near = closest_match(name, names);
  throw Error({"driver", fmt::format("'{}' is not known", excerpt(name)),
               fmt::format("{}", fmt::join(names, " ")),
               near.empty() ? "" : fmt::format("did you mean '{}'?", near)});
}

const Driver& own_driver(const Sensor& sensor) {
  return own_drivers()[is_pinhole(sensor) ? 1 : 0];
}

bool suits(const Driver& driver, const Sensor& sensor, const Beams& beams) {
  switch (driver.sensors) {
    case DriverSensors::scanners:
      return !is_pinhole(sensor);
    case DriverSensors::spinning:
      return std::holds_alternative<Spinning>(sensor.optics);
    case DriverSensors::planar:
      return !is_pinhole(sensor) && beams.rows == beams.returns;
    case DriverSensors::cameras:
      return is_pinhole(sensor);
  }
  return false;
}

std::string driver_sensors_text(const Driver& driver) {
  switch (driver.sensors) {
    case DriverSensors::scanners:
      return "a LiDAR";
    case DriverSensors::spinning:
      return "a spinning LiDAR";
    case DriverSensors::planar:
      return "a scanner with one row";
    case DriverSensors::cameras:
      break;
  }
  return "a camera";
}

bool has_infrared(const Sensor& sensor) {
  const DepthCamera* camera = physical_camera(sensor);
  const auto* stereo = camera == nullptr ? nullptr : std::get_if<ActiveStereo>(camera);
  return stereo != nullptr && stereo->reference == ActiveStereo::Reference::right_imager;
}

double stereo_baseline_m(const Sensor& sensor) {
  const DepthCamera* camera = physical_camera(sensor);
  const auto* stereo = camera == nullptr ? nullptr : std::get_if<ActiveStereo>(camera);
  return stereo == nullptr ? 0.0 : stereo->baseline_m;
}

}  // namespace glidar::ros
