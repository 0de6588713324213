// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/ros2_options.hpp>

#include <apps/glidar/options/option_group.hpp>
#include <glidar/core/error.hpp>
#include <glidar/link/dds/pose_topic.hpp>
#include <glidar/link/dds/topic_names.hpp>

#include <CLI/CLI.hpp>

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

}  // namespace glidar::app
