// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/image_transport.hpp>

#include <apps/glidar/options/cli_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// The connection to ROS 2 as given on the command line.
struct Ros2Flags {
  bool publishes = false;             ///< --ros2
  std::string ros_namespace;          ///< of the topics; empty: none
  std::string interface_name = "lo";  ///< network interface
  std::string pose_topic;             ///< of --pose-source ros2:TOPIC; empty: none
};

/// Whether there is any connection.
inline bool uses_ros2(const Ros2Flags& flags) {
  return flags.publishes || !flags.pose_topic.empty();
}

/// Whether the clock of ROS gives the times of frames, but no poses.
bool follows_ros_clock(const Ros2Flags& flags);

/// How a source of poses in ROS 2 begins: ros2:/odom.
inline constexpr const char* kRos2Prefix = "ros2:";

/// Adds the options for publishing.
void add_ros2_options(CLI::App& command, Ros2Flags& flags);

/// Throws Error when an option of a connection is given without one.
void check_ros2_options(const CLI::App& command, const Ros2Flags& flags);

/// Sets the topic of poses from "ros2:TOPIC". Throws Error.
void set_ros2_pose_source(const std::string& text, Ros2Flags& flags);

}  // namespace glidar::app

namespace glidar::ros {
enum class TransformMode : std::uint8_t;
struct Driver;
}  // namespace glidar::ros

namespace glidar::app {

/// --as [SENSOR=]DRIVER.
struct DriverFlag {
  std::string sensor_name;  ///< empty: all that the driver suits
  const ros::Driver* driver = nullptr;
};

/// The messages of ROS in bags and on the network.
struct MessageFlags {
  std::vector<DriverFlag> drivers;
  std::optional<ros::TransformMode> tf;  ///< empty: ground truth, or map for viewers
  std::string frame_prefix;
  bool imu_orientation = false;
  bool depth_in_mm = false;                               ///< raw depth images are 16UC1
  ros::ImageTransport images = ros::ImageTransport::raw;  ///< of cameras
  bool packet_topics = false;  ///< packets of Ouster and Velodyne sensors
};

/// Adds the options of messages.
void add_message_options(CLI::App& command, MessageFlags& flags);

/// Removes them from a command that writes no messages.
void remove_message_options(CLI::App& command);

/// The first of these options that is given and has no effect without messages; empty: none.
std::string given_message_option(const MessageFlags& flags);

/// The drivers, for the end of --help.
std::string driver_names_text();

}  // namespace glidar::app
