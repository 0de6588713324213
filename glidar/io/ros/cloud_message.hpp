// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/point_cloud.hpp>
#include <glidar/io/ros/messages.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::ros {

/// What a cloud was measured with.
struct CloudSource {
  const Frame& frame;
  const Sensor& sensor;
  const Beams& beams;
};

struct CloudMessageOptions {
  std::string layout = {};    ///< of cloud_layouts(); empty: all columns of the cloud
  bool dense = true;          ///< omit points without a return
  bool firing_order = true;   ///< sort points by firing time, stably; false: rows and columns
  std::string frame_id = {};  ///< empty: that of the cloud
};

/// The layout that requires a CustomMsg instead of a PointCloud2.
inline constexpr std::string_view kCustomMsgLayout = "livox-custom";

/// The time of the first firing of a frame, ns: the stamp of its messages.
std::int64_t first_firing_ns(const Frame& frame, const Beams& beams);

/// The points of the cloud that its message has, by index, in the order of the message.
std::vector<std::uint32_t> message_points(const PointCloud& cloud, const Beams& beams,
                                          const CloudMessageOptions& options = {});

/// The points of a cloud of all beams (or with a column `time`) as a message, whose stamp is the
/// time of the first firing; relative times count from it. Coordinates are float32; other columns
/// keep their type, `colour` becomes PCL's `rgb`, and `stamp` becomes float64, ns. The bytes are
/// written when the message is serialized; the message owns all that it needs for that.
/// Throws Error when a column is missing, or the stamp is outside the range of ROS.
PointCloud2 to_point_cloud2(const PointCloud& cloud, const CloudSource& source,
                            const CloudMessageOptions& options = {});

/// The points as livox_ros_driver2/CustomMsg, always dense, in the fields of the layout
/// kCustomMsgLayout; options.layout is ignored. Throws Error as above, and for stamps before 1970.
CustomMsg to_custom_msg(const PointCloud& cloud, const CloudSource& source,
                        const CloudMessageOptions& options = {});

}  // namespace glidar::ros
