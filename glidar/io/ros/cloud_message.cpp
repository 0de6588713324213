// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/cloud_message.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/formats/point_rows.hpp>
#include <glidar/io/ros/firing_order.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

namespace glidar::ros {
namespace {

/// Since the start of the frame.
std::uint32_t first_time_ns(const Beams& beams) {
  if (beams.times_ns.empty()) return 0;
  std::uint32_t first = std::numeric_limits<std::uint32_t>::max();
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (!std::isnan(beams.directions[i].x())) first = std::min(first, beams.times_ns[i]);
  }
  return first == std::numeric_limits<std::uint32_t>::max() ? 0 : first;
}

[[noreturn]] void require_column(const char* name) {
  throw Error({"cloud message", std::string("the cloud has no column ") + name,
               "a cloud with it, or one of all beams", "request the column"});
}

const std::vector<double>& coordinates_of(const PointCloud& cloud) {
  const Column* xyz = find_column(cloud, "xyz");
  const auto* values = xyz == nullptr ? nullptr : std::get_if<std::vector<double>>(&xyz->values);
  if (values == nullptr) require_column("xyz");
  return *values;
}

/// Firing times of all points; empty: all at once.
std::span<const std::uint32_t> times_of(const PointCloud& cloud, const Beams& beams) {
  if (beams.times_ns.empty()) return {};
  if (cloud.size() == beams.size()) return beams.times_ns;
  const Column* time = find_column(cloud, "time");
  const auto* values =
      time == nullptr ? nullptr : std::get_if<std::vector<std::uint32_t>>(&time->values);
  if (values == nullptr) require_column("time");
  return *values;
}

/// Times since the first firing instead of the start of the frame.
void count_from(std::uint32_t first_ns, Column& column) {
  if (first_ns == 0 || column.name != "time") return;
  for (std::uint32_t& time_ns : std::get<std::vector<std::uint32_t>>(column.values))
    time_ns -= std::min(time_ns, first_ns);
}

/// The columns that the message needs, of the points and in the order of the options.
PointCloud chosen_cloud(const PointCloud& cloud, const CloudSource& source,
                        const CloudMessageOptions& options) {
  const bool keeps_grid = !options.dense && !options.firing_order;
  const std::vector<std::uint32_t> points = message_points(cloud, source.beams, options);
  PointCloud chosen{cloud.rows, cloud.cols, cloud.frame_id, cloud.world_from_cloud, {}};
  if (!keeps_grid) chosen.rows = 1;
  if (!keeps_grid) chosen.cols = static_cast<std::uint32_t>(points.size());
  std::span<const std::string> needed;
  if (!options.layout.empty()) needed = find_layout(options.layout).columns;
  const std::uint32_t first_ns = first_time_ns(source.beams);
  for (const Column& column : cloud.columns) {
    if (!needed.empty() && std::find(needed.begin(), needed.end(), column.name) == needed.end())
      continue;
    select_points(column, points, chosen.columns.emplace_back());
    count_from(first_ns, chosen.columns.back());
  }
  if (options.layout.empty()) return chosen;
  return apply_layout(chosen, options.layout, source.sensor, source.beams);
}

/// Fields as PCL's conversions expect them: coordinates are float32, colour is packed.
std::vector<glidar::PointField> message_fields(const PointCloud& cloud) {
  std::vector<glidar::PointField> fields;
  for (const Column& column : cloud.columns) {
    if (native_type(column) == Stored::i64) {
      append_split_time(column, fields);
      continue;
    }
    for (glidar::PointField& field : append_pcl_fields(column, fields)) {
      if (column.name == "xyz") field.stored = Stored::f32;
    }
  }
  return fields;
}

std::uint8_t datatype_of(Stored stored) {
  switch (stored) {
    case Stored::f32:
    case Stored::packed_rgb:  // as PCL declares it
      return PointField::float32;
    case Stored::f64:
    case Stored::i64:  // not used
      return PointField::float64;
    case Stored::u8:
    case Stored::colour_byte:
      return PointField::uint8;
    case Stored::u16:
      return PointField::uint16;
    case Stored::u32:
    case Stored::whole_s:
    case Stored::rest_ns:
      return PointField::uint32;
  }
  return 0;
}

/// The points that a message serializes later.
struct Packed {
  PointCloud cloud;
  std::vector<glidar::PointField> fields;
};

std::uint32_t checked_size(std::size_t bytes) {
  if (bytes <= std::numeric_limits<std::uint32_t>::max() / 2)
    return static_cast<std::uint32_t>(bytes);
  throw Error({"PointCloud2", std::to_string(bytes) + " bytes of points", "less than 2 GiB",
               "use fewer points or a layout"});
}

Header header_of(const PointCloud& cloud, const CloudSource& source,
                 const CloudMessageOptions& options) {
  return {.stamp = time_from_ns(first_firing_ns(source.frame, source.beams)),
          .frame_id = options.frame_id.empty() ? cloud.frame_id : options.frame_id};
}

template <class Number>
const std::vector<Number>& values_of(const PointCloud& cloud, const char* name) {
  return std::get<std::vector<Number>>(find_column(cloud, name)->values);
}

}  // namespace

std::int64_t first_firing_ns(const Frame& frame, const Beams& beams) {
  return frame.stamp_ns + first_time_ns(beams);
}

std::vector<std::uint32_t> message_points(const PointCloud& cloud, const Beams& beams,
                                          const CloudMessageOptions& options) {
  std::vector<std::uint32_t> points(cloud.size());
  if (options.dense) {
    const std::vector<double>& xyz = coordinates_of(cloud);
    std::size_t count = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {  // no branch, as misses are irregular
      points[count] = static_cast<std::uint32_t>(i);
      count += std::isnan(xyz[3 * i]) ? 0U : 1U;
    }
    points.resize(count);
  } else {
    std::iota(points.begin(), points.end(), 0U);
  }
  const auto times = options.firing_order ? times_of(cloud, beams) : std::span<std::uint32_t>{};
  if (!times.empty()) sort_by_time(times, points);
  return points;
}

PointCloud2 to_point_cloud2(const PointCloud& cloud, const CloudSource& source,
                            const CloudMessageOptions& options) {
  auto packed = std::make_shared<Packed>();
  packed->cloud = chosen_cloud(cloud, source, options);
  packed->fields = message_fields(packed->cloud);
  PointCloud2 message;
  message.header = header_of(cloud, source, options);
  message.height = packed->cloud.rows;
  message.width = packed->cloud.cols;
  std::uint32_t offset = 0;
  for (const glidar::PointField& field : packed->fields) {
    message.fields.push_back({field.name, offset, datatype_of(field.stored), 1});
    offset += static_cast<std::uint32_t>(type_of(field.stored).bytes);
  }
  message.point_step = offset;
  message.row_step = checked_size(std::size_t{offset} * message.width);
  message.is_dense = options.dense;
  const std::size_t size = checked_size(std::size_t{offset} * packed->cloud.size());
  message.data = Payload(size, [packed](std::span<std::byte> to) {
    if (!to.empty()) pack_rows(packed->fields, 0, packed->cloud.size(), to);
  });
  return message;
}

CustomMsg to_custom_msg(const PointCloud& cloud, const CloudSource& source,
                        const CloudMessageOptions& options) {
  CloudMessageOptions dense = options;
  dense.layout = kCustomMsgLayout;
  dense.dense = true;
  const PointCloud chosen = chosen_cloud(cloud, source, dense);
  const std::int64_t stamp_ns = first_firing_ns(source.frame, source.beams);
  if (stamp_ns < 0) {
    throw Error({"CustomMsg", "a stamp of " + std::to_string(stamp_ns) + " ns", "0 or more",
                 "start at another time"});
  }
  CustomMsg message;
  message.header = header_of(cloud, source, options);
  message.timebase = static_cast<std::uint64_t>(stamp_ns);
  message.point_num = static_cast<std::uint32_t>(chosen.size());
  const auto& times = values_of<std::uint32_t>(chosen, "offset_time");
  const auto& x = values_of<float>(chosen, "x");
  const auto& y = values_of<float>(chosen, "y");
  const auto& z = values_of<float>(chosen, "z");
  const auto& reflectivity = values_of<std::uint8_t>(chosen, "reflectivity");
  const auto& tag = values_of<std::uint8_t>(chosen, "tag");
  const auto& line = values_of<std::uint8_t>(chosen, "line");
  message.points.reserve(chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i)
    message.points.push_back({times[i], x[i], y[i], z[i], reflectivity[i], tag[i], line[i]});
  return message;
}

}  // namespace glidar::ros
