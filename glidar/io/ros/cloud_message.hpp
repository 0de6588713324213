// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/io/ros/messages.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::ros {

/// Sorts point indices by their times, stably. A time is that of times_ns[point].
void sort_by_time(std::span<const std::uint32_t> times_ns, std::vector<std::uint32_t>& points);

/// What a cloud was measured with.
struct CloudSource {
  const Frame& frame;
  const Sensor& sensor;
  const Beams& beams;
};

/// Points without a return.
enum class Misses : std::uint8_t {
  omitted,
  nan,   ///< their coordinates are NaN
  zero,  ///< their coordinates are 0
};

/// The order of points. A column is what a scanner fires at one azimuth, once for each return.
enum class PointOrder : std::uint8_t {
  firing,       ///< by firing time, stably; one row
  rows,         ///< as the beams: height = channels; one row without misses
  destaggered,  ///< the same, each row shifted so that columns have one azimuth (Ouster)
  columns,      ///< height = columns, width = channels in the order of the beams
  rings,        ///< the same, channels by their ring
};

/// The stamp of a cloud, from which relative times count.
enum class StampRule : std::uint8_t {
  first_point,   ///< the firing of the first point that is written
  first_firing,  ///< the first firing of the frame
  /// The end of the last packet; times count from its start, because a driver takes the time at
  /// which it receives a packet for that of its first firing.
  last_packet,
};

/// How a cloud becomes a message. The default suits all consumers that are known.
struct CloudMessageOptions {
  std::string layout = {};    ///< of cloud_layouts(); empty: all columns of the cloud
  std::string frame_id = {};  ///< empty: that of the cloud
  Misses misses = Misses::omitted;
  PointOrder order = PointOrder::firing;
  StampRule stamp = StampRule::first_point;
  bool packet_stamps = false;            ///< `stamp` of a point is that of its packet
  std::optional<bool> is_dense = {};     ///< empty: whether no coordinate is NaN
  bool intensity_of_misses_nan = false;  ///< with a layout; else 0
  double min_range_m = 0.0;              ///< points outside these ranges are misses
  double max_range_m = kInfinity;
  std::vector<std::uint32_t> offsets = {};  ///< of the layout's fields; empty: no padding
  std::uint32_t point_step = 0;             ///< with `offsets`
};

/// The layout that requires a CustomMsg instead of a PointCloud2.
inline constexpr std::string_view kCustomMsgLayout = "livox-custom";

/// The time of the first firing of a frame, ns: the stamp of its images and scans.
std::int64_t first_firing_ns(const Frame& frame, const Beams& beams);

/// The stamp of a frame's cloud.
std::int64_t cloud_stamp_ns(const CloudSource& source, const CloudMessageOptions& options = {});

/// The points of the cloud that its message has, by index, in the order of the message.
std::vector<std::uint32_t> message_points(const PointCloud& cloud, const CloudSource& source,
                                          const CloudMessageOptions& options = {});

/// The points of a cloud of all beams (or with a column `time`) as a message. Coordinates are
/// float32; other columns keep their type, `colour` becomes PCL's `rgb`, and `stamp` becomes
/// float64, ns. The bytes are written when the message is serialized; the message owns all that it
/// needs for that. Throws Error when a column is missing, or the stamp is outside the range of ROS.
PointCloud2 to_point_cloud2(const PointCloud& cloud, const CloudSource& source,
                            const CloudMessageOptions& options = {});

/// The points as livox_ros_driver2/CustomMsg, in the fields of the layout kCustomMsgLayout;
/// options.layout is ignored. Throws Error as above, and for stamps before 1970.
CustomMsg to_custom_msg(const PointCloud& cloud, const CloudSource& source,
                        const CloudMessageOptions& options = {});

/// The columns by which the rows of an Ouster's images are shifted: pixel_shift_by_row.
std::vector<std::size_t> row_shifts(const Sensor& sensor, const Beams& beams);

/// The points of a message with any fields, offsets and byte order, in the frame
/// message.header.frame_id. x, y and z become the column `xyz`; other fields become columns of
/// their name, see FileText::column_name(), with a number if that is in use: a_b and a.b become a_b
/// and a_b_2. Signed integers become int64. Throws Error when sizes contradict each other,
/// fields overlap or repeat, or x, y or z are missing or no floats.
PointCloud to_point_cloud(const PointCloud2& message);

/// The same for a CustomMsg: columns xyz, reflectivity, tag, line and offset_time, ns since
/// timebase.
PointCloud to_point_cloud(const CustomMsg& message);

}  // namespace glidar::ros
