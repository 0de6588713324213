// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace glidar::dds {

/// The full name of a ROS topic: names without a leading slash are in the namespace, which may be
/// empty, "robot" or "/fleet/robot". Throws Error unless it is a valid name of ROS 2:
/// design.ros2.org/articles/topic_and_service_names.html.
std::string full_topic_name(std::string_view name, std::string_view ros_namespace = {});

/// The name of a topic in DDS: rt/velodyne_points for /velodyne_points.
std::string dds_topic_name(std::string_view full_name);

}  // namespace glidar::dds
