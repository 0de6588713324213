// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <glidar/io/ros/image_transport.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

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
