// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/message_options.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/ros/published_rig.hpp>
#include <glidar/link/dds/topic_names.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>

#include <algorithm>
#include <string_view>

namespace glidar::app {

bool follows_ros_clock(const Ros2Flags& flags) {
  return flags.pose_topic == "/clock";
}

void add_ros2_options(CLI::App& command, Ros2Flags& flags) {
  const OptionGroup group(command, "Topics of ROS 2 (ROS_DOMAIN_ID selects the domain)");
  group.add_flag("--ros2", "Publish clouds, images, poses and the clock as topics [off]",
                 flags.publishes);
  group.add("--namespace", "NS", "Namespace of the topics but /tf and /clock [none]",
            flags.ros_namespace, [](const std::string& text) {
              (void)dds::full_topic_name("topic", text);
              return text;
            });
  group.add("--ros2-interface", "NAME", "Network interface; auto: the choice of Cyclone DDS [lo]",
            flags.interface_name);
}

void check_ros2_options(const CLI::App& command, const Ros2Flags& flags) {
  if (uses_ros2(flags)) return;
  for (const char* name : {"--namespace", "--ros2-interface"}) {
    if (command.count(name) == 0) continue;
    throw Error(
        {name, "given without a connection to ROS 2", "", "add --ros2, which publishes topics"});
  }
}

void set_ros2_pose_source(const std::string& text, Ros2Flags& flags) {
  const std::string topic = text.substr(std::string_view(kRos2Prefix).size());
  (void)dds::parse_pose_topic(topic);
  flags.pose_topic = topic;
}

namespace {

constexpr const char* kMessageHeading = "ROS messages in bags and --ros2";

SensorDriver parse_driver(const std::string& text) {
  const std::size_t equals = text.find('=');
  const bool has_sensor = equals != std::string::npos;
  if (has_sensor && equals == 0) refuse_value(text, "[SENSOR=]DRIVER");
  return {has_sensor ? text.substr(0, equals) : "",
          &ros::find_driver(has_sensor ? std::string_view(text).substr(equals + 1) : text)};
}

/// REP-103 and tf2: names of frames have no leading slash.
std::string parse_frame_prefix(const std::string& text) {
  const auto is_allowed = [](char letter) {
    const bool is_letter = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z');
    return is_letter || (letter >= '0' && letter <= '9') || letter == '_' || letter == '/';
  };
  if (text.starts_with('/') || !std::all_of(text.begin(), text.end(), is_allowed))
    refuse_value(text, "letters, digits, _ and /, but no / at the start", "robot1/, for example");
  return text;
}

}  // namespace

void add_message_options(CLI::App& command, MessageOptions& flags) {
  const OptionGroup group(command, kMessageHeading);
  group.add_repeatable(
      "--as", "[SENSOR=]DRIVER", "As a maker's driver publishes, see below; repeatable",
      [&flags](const std::string& text) {
        with_option_name("--as", [&] { flags.drivers.push_back(parse_driver(text)); });
      });
  group.add("--tf", "NAME", "Poses in /tf: ground_truth, odom, map or none [ground_truth]",
            flags.tf,
            one_of<ros::TransformMode>({{"ground_truth", ros::TransformMode::ground_truth},
                                        {"odom", ros::TransformMode::odom},
                                        {"map", ros::TransformMode::map},
                                        {"none", ros::TransformMode::none}}));
  group.add("--frame-prefix", "PREFIX", "Before the names of all frames but map: robot1/ [none]",
            flags.frame_prefix, parse_frame_prefix);
  group.add_flag("--imu-orientation", "True orientations in IMU messages [marked as absent]",
                 flags.imu_orientation);
  group.add("--depth-image", "NAME", "Raw depth images: 32FC1 in m or 16UC1 in mm [32FC1]",
            flags.depth_in_mm, one_of<bool>({{"32FC1", false}, {"16UC1", true}}));
  group.add("--image-transport", "NAME", "Images of cameras: raw, compressed or both [raw]",
            flags.images,
            one_of<ros::ImageTransport>({{"raw", ros::ImageTransport::raw},
                                         {"compressed", ros::ImageTransport::compressed},
                                         {"both", ros::ImageTransport::both}}));
  group.add_flag("--packet-topics", "Also packets of Ouster and Velodyne sensors",
                 flags.packet_topics);
}

void remove_message_options(CLI::App& command) {
  for (const std::string& name : options_under(command, kMessageHeading))
    command.remove_option(command.get_option(name));
}

std::string given_message_option(const MessageOptions& flags) {
  if (!flags.drivers.empty()) return "--as";
  if (!flags.frame_prefix.empty()) return "--frame-prefix";
  if (flags.imu_orientation) return "--imu-orientation";
  if (flags.depth_in_mm) return "--depth-image";
  if (flags.packet_topics) return "--packet-topics";
  return flags.images == ros::ImageTransport::raw ? "" : "--image-transport";
}

std::string driver_names_text() {
  std::string text = "\nDrivers of --as:\n";
  for (const ros::Driver& driver : ros::drivers())
    text += fmt::format("  {:<12} {}\n", driver.name, driver.package);
  return text;
}

}  // namespace glidar::app
