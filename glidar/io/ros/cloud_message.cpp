// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/cloud_message.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/formats/point_rows.hpp>
#include <glidar/io/packets/hesai_packet.hpp>
#include <glidar/io/ros/firing_order.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <utility>
#include <variant>

namespace glidar::ros {
namespace {

/// The columns that a scanner's driver receives in one packet: those of the maker's format, or
/// about 384 points.
std::size_t columns_per_packet(const Sensor& sensor, const Beams& beams) {
  constexpr std::size_t kPacketPoints = 384;  // of all models of Velodyne
  if (const HesaiModel* model = find_hesai_model(sensor))
    return model->blocks / std::max<std::size_t>(1, beams.returns);
  return std::max<std::size_t>(1, kPacketPoints / std::max<std::size_t>(1, beams.rows));
}

/// The time that such a packet states, ns after its first firing; 0 for other makers' packets.
std::int64_t packet_time_offset_ns(const Sensor& sensor, const Beams& beams) {
  const HesaiModel* model = find_hesai_model(sensor);
  const auto* spinning = std::get_if<Spinning>(&sensor.optics);
  if (model == nullptr || spinning == nullptr || spinning->channels.empty()) return 0;
  const auto earliest = std::min_element(
      spinning->channels.begin(), spinning->channels.end(),
      [](const auto& a, const auto& b) { return a.fire_time_ns < b.fire_time_ns; });
  const double start_ns = sequence_start_ns(*model, 0, columns_per_packet(sensor, beams));
  return -std::llround(start_ns + earliest->fire_time_ns);
}

/// The entries of the beams of a grid in an order other than PointOrder::firing and rows.
std::vector<std::uint32_t> ordered_entries(const Sensor& sensor, const Beams& beams,
                                           PointOrder order) {
  std::vector<std::uint32_t> entries;
  entries.reserve(beams.size());
  const auto entry = [&](std::size_t row, std::size_t col) {
    entries.push_back(static_cast<std::uint32_t>(row * beams.cols + col));
  };
  if (order == PointOrder::destaggered) {
    const std::vector<std::size_t> shifts = row_shifts(sensor, beams);
    for (std::size_t row = 0; row < beams.rows; ++row)
      for (std::size_t col = 0; col < beams.cols; ++col)
        entry(row, (col + beams.cols - shifts[row]) % beams.cols);
    return entries;
  }
  std::vector<std::size_t> rows(beams.rows);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  const std::size_t channels = beams.rows / beams.returns;
  if (order == PointOrder::rings) {
    std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(a / channels, ring_of(beams, a * beams.cols)) <
             std::pair(b / channels, ring_of(beams, b * beams.cols));
    });
  }
  for (std::size_t col = 0; col < beams.cols; ++col)
    for (const std::size_t row : rows) entry(row, col);
  return entries;
}

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

/// Since the start of the frame, of the first beam with a return; empty: there is none.
std::optional<std::uint32_t> first_return_ns(const Frame& frame, const Beams& beams) {
  if (beams.times_ns.empty() || frame.range_m.size() != beams.size()) return std::nullopt;
  std::optional<std::uint32_t> first;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (!std::isnan(frame.range_m[i]))
      first = std::min(first.value_or(beams.times_ns[i]), beams.times_ns[i]);
  }
  return first;
}

/// The time between columns.
double column_period_ns(const Sensor& sensor, const Beams& beams) {
  if (const auto* spinning = std::get_if<Spinning>(&sensor.optics))
    return sequence_period_ns(*spinning);
  constexpr double kSecondNs = 1e9;
  return kSecondNs / sensor.rate_hz / std::max<double>(1.0, beams.cols);
}

/// The stamp of a message and the time from which the times of its points count.
struct CloudTimes {
  std::int64_t stamp_ns = 0;
  std::int64_t zero_ns = 0;
};

/// The time that a packet states, in whole microseconds, from that of its first firing.
std::int64_t packet_time_ns(std::int64_t first_ns, std::int64_t offset_ns) {
  constexpr std::int64_t kMicrosecondNs = 1000;
  const std::int64_t time_ns = first_ns + offset_ns;
  return time_ns - time_ns % kMicrosecondNs;
}

CloudTimes cloud_times(const CloudSource& source, const CloudMessageOptions& options) {
  const auto [frame, sensor, beams] = source;
  std::int64_t first_ns = frame.stamp_ns + first_time_ns(beams);
  if (options.stamp == StampRule::first_point && options.misses == Misses::omitted) {
    if (const auto first = first_return_ns(frame, beams)) first_ns = frame.stamp_ns + *first;
  }
  if (options.packet_stamps)
    return {packet_time_ns(first_ns, packet_time_offset_ns(sensor, beams)), first_ns};
  if (options.stamp != StampRule::last_packet) return {first_ns, first_ns};
  const std::size_t columns = columns_per_packet(sensor, beams);
  const double period_ns = column_period_ns(sensor, beams);
  const auto packet_ns = std::llround(period_ns * static_cast<double>(columns));
  const auto frame_ns = std::llround(period_ns * static_cast<double>(beams.cols));
  const std::int64_t end_ns = first_ns + std::max<std::int64_t>(frame_ns, packet_ns);
  return {end_ns, end_ns - packet_ns};
}

/// Whether the message leaves out a point, or marks it as a miss.
std::vector<bool> misses_of(const std::vector<double>& xyz, const CloudMessageOptions& options) {
  const double min = options.min_range_m * options.min_range_m;
  const double max = options.max_range_m * options.max_range_m;
  std::vector<bool> misses(xyz.size() / 3);
  for (std::size_t i = 0; i < misses.size(); ++i) {
    const double squared = Eigen::Map<const Eigen::Vector3d>(&xyz[3 * i]).squaredNorm();
    misses[i] = !(squared >= min && squared <= max);  // NaN too
  }
  return misses;
}

/// Times since `zero_ns` instead of the start of the frame. Only fields of layouts can have
/// negative times.
void count_from(std::int64_t zero_ns, bool can_be_negative, Column& column) {
  const auto times = std::get<std::vector<std::uint32_t>>(column.values);
  std::vector<std::int64_t> counted(times.begin(), times.end());
  for (std::int64_t& time_ns : counted) time_ns -= zero_ns;
  if (can_be_negative) {
    column.values = std::move(counted);
    return;
  }
  auto& values = std::get<std::vector<std::uint32_t>>(column.values);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<std::uint32_t>(std::max<std::int64_t>(0, counted[i]));
}

/// The stamp of each point becomes the time that its packet states. A packet without a beam states
/// none.
void take_packet_stamps(const CloudSource& source, const std::vector<std::uint32_t>& points,
                        Column& column) {
  const Beams& beams = source.beams;
  if (beams.times_ns.empty()) return;
  const std::size_t columns = columns_per_packet(source.sensor, beams);
  constexpr std::int64_t kNoBeam = std::numeric_limits<std::int64_t>::max();
  std::vector<std::int64_t> first_ns(beams.cols / columns + 1, kNoBeam);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (std::isnan(beams.directions[i].x())) continue;
    std::int64_t& first = first_ns[i % beams.cols / columns];
    first = std::min(first, source.frame.stamp_ns + beams.times_ns[i]);
  }
  auto& stamps = std::get<std::vector<std::int64_t>>(column.values);
  const std::int64_t offset_ns = packet_time_offset_ns(source.sensor, beams);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::int64_t first = first_ns[points[i] % beams.cols / columns];
    if (first != kNoBeam) stamps[i] = packet_time_ns(first, offset_ns);
  }
}

/// Coordinates of misses as the options ask for them.
void mark_misses(const std::vector<std::uint32_t>& points, const std::vector<bool>& misses,
                 Misses kind, Column& xyz) {
  auto& values = std::get<std::vector<double>>(xyz.values);
  const double value = kind == Misses::zero ? 0.0 : kNaN;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (misses[points[i]])
      std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, value);
  }
}

/// Intensities of misses in the field of a layout.
void mark_intensities(const std::vector<std::uint32_t>& points, const std::vector<bool>& misses,
                      float value, PointCloud& cloud) {
  for (Column& column : cloud.columns) {
    auto* values = std::get_if<std::vector<float>>(&column.values);
    if (column.name != "intensity" || values == nullptr) continue;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (misses[points[i]]) (*values)[i] = value;
  }
}

/// The grid of the message; without one a row of all its points.
void set_shape(const CloudMessageOptions& options, std::size_t points, PointCloud& cloud) {
  const bool has_grid = options.misses != Misses::omitted && options.order != PointOrder::firing;
  const bool is_turned = options.order == PointOrder::columns || options.order == PointOrder::rings;
  if (!has_grid) {
    cloud.rows = 1;
    cloud.cols = static_cast<std::uint32_t>(points);
  } else if (is_turned) {
    std::swap(cloud.rows, cloud.cols);
  }
}

/// The columns that the message needs, of the points and in the order of the options.
PointCloud chosen_cloud(const PointCloud& cloud, const CloudSource& source,
                        const CloudMessageOptions& options) {
  const std::vector<std::uint32_t> points = message_points(cloud, source, options);
  const std::vector<bool> misses = misses_of(coordinates_of(cloud), options);
  PointCloud chosen{cloud.rows, cloud.cols, cloud.frame_id, cloud.world_from_cloud, {}};
  set_shape(options, points.size(), chosen);
  std::span<const std::string> needed;
  if (!options.layout.empty()) needed = find_layout(options.layout).columns;
  const std::int64_t zero_ns = cloud_times(source, options).zero_ns - source.frame.stamp_ns;
  const bool is_late = options.stamp == StampRule::last_packet;
  for (const Column& column : cloud.columns) {
    if (!needed.empty() && std::find(needed.begin(), needed.end(), column.name) == needed.end())
      continue;
    Column& made = chosen.columns.emplace_back();
    select_points(column, points, made);
    if (made.name == "time") count_from(zero_ns, is_late, made);
    if (made.name == "stamp" && options.packet_stamps) take_packet_stamps(source, points, made);
    if (made.name == "xyz") mark_misses(points, misses, options.misses, made);
  }
  if (options.layout.empty()) return chosen;
  PointCloud laid = apply_layout(chosen, options.layout, source.sensor, source.beams);
  if (options.misses != Misses::omitted)
    mark_intensities(points, misses, options.intensity_of_misses_nan ? kNaNf : 0.0F, laid);
  return laid;
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
  std::vector<std::uint32_t> offsets;  ///< of the fields; empty: no padding
  std::uint32_t step = 0;
};

/// All points, with padding between their fields.
void pack_padded(const Packed& packed, std::span<std::byte> to) {
  std::fill(to.begin(), to.end(), std::byte{0});
  std::vector<std::byte> numbers;
  for (std::size_t f = 0; f < packed.fields.size(); ++f) {
    const std::span<const glidar::PointField> field(&packed.fields[f], 1);
    const std::size_t size = row_bytes(field);
    numbers.resize(size * packed.cloud.size());
    pack_rows(field, 0, packed.cloud.size(), numbers);
    for (std::size_t i = 0; i < packed.cloud.size(); ++i)
      std::copy_n(&numbers[size * i], size, &to[packed.step * i + packed.offsets[f]]);
  }
}

bool has_nan(const PointCloud& cloud, const CloudMessageOptions& options) {
  if (options.misses != Misses::nan) return false;
  const Column* x = find_column(cloud, options.layout.empty() ? "xyz" : "x");
  if (x == nullptr) return false;
  const auto is_nan = [](auto value) { return std::isnan(static_cast<double>(value)); };
  return std::visit(
      [&](const auto& values) { return std::any_of(values.begin(), values.end(), is_nan); },
      x->values);
}

std::uint32_t checked_size(std::size_t bytes) {
  if (bytes <= std::numeric_limits<std::uint32_t>::max() / 2)
    return static_cast<std::uint32_t>(bytes);
  throw Error({"PointCloud2", std::to_string(bytes) + " bytes of points", "less than 2 GiB",
               "use fewer points or a layout"});
}

Header header_of(const PointCloud& cloud, const CloudSource& source,
                 const CloudMessageOptions& options) {
  return {.stamp = time_from_ns(cloud_stamp_ns(source, options)),
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

std::int64_t cloud_stamp_ns(const CloudSource& source, const CloudMessageOptions& options) {
  return cloud_times(source, options).stamp_ns;
}

std::vector<std::uint32_t> message_points(const PointCloud& cloud, const CloudSource& source,
                                          const CloudMessageOptions& options) {
  const Beams& beams = source.beams;
  const bool is_as_beams = options.order == PointOrder::firing || options.order == PointOrder::rows;
  std::vector<std::uint32_t> points;
  if (is_as_beams) {
    points.resize(cloud.size());
    std::iota(points.begin(), points.end(), 0U);
  } else {
    points = ordered_entries(source.sensor, beams, options.order);
  }
  if (options.misses == Misses::omitted) {
    const std::vector<bool> misses = misses_of(coordinates_of(cloud), options);
    std::erase_if(points, [&](std::uint32_t point) { return misses[point]; });
  }
  const auto times =
      options.order == PointOrder::firing ? times_of(cloud, beams) : std::span<std::uint32_t>{};
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
  packed->offsets = options.offsets;
  const bool is_padded = !packed->offsets.empty();
  std::uint32_t end = 0;
  for (std::size_t i = 0; i < packed->fields.size(); ++i) {
    const glidar::PointField& field = packed->fields[i];
    const std::uint32_t offset = is_padded ? packed->offsets.at(i) : end;
    message.fields.push_back({field.name, offset, datatype_of(field.stored), 1});
    end = offset + static_cast<std::uint32_t>(type_of(field.stored).bytes);
  }
  packed->step = is_padded ? options.point_step : end;
  message.point_step = packed->step;
  message.row_step = checked_size(std::size_t{packed->step} * message.width);
  message.is_dense = options.is_dense.value_or(!has_nan(packed->cloud, options));
  const std::size_t size = checked_size(std::size_t{packed->step} * packed->cloud.size());
  message.data = Payload(size, [packed, is_padded](std::span<std::byte> to) {
    if (to.empty()) return;
    if (is_padded) return pack_padded(*packed, to);
    pack_rows(packed->fields, 0, packed->cloud.size(), to);
  });
  return message;
}

CustomMsg to_custom_msg(const PointCloud& cloud, const CloudSource& source,
                        const CloudMessageOptions& options) {
  CloudMessageOptions custom = options;
  custom.layout = kCustomMsgLayout;
  const PointCloud chosen = chosen_cloud(cloud, source, custom);
  const std::int64_t stamp_ns = cloud_stamp_ns(source, options);
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

std::vector<std::size_t> row_shifts(const Sensor& sensor, const Beams& beams) {
  std::vector<std::size_t> shifts(beams.rows, 0);
  const auto* spinning = std::get_if<Spinning>(&sensor.optics);
  if (spinning == nullptr || spinning->columns_per_turn != beams.cols) return shifts;
  const auto columns = static_cast<long>(beams.cols);
  std::vector<const SpinningChannel*> by_row;
  for (const SpinningChannel& channel : spinning->channels) by_row.push_back(&channel);
  std::stable_sort(by_row.begin(), by_row.end(), [](const auto* a, const auto* b) {
    return a->elevation_rad > b->elevation_rad;
  });
  for (std::size_t row = 0; row < shifts.size(); ++row) {
    const SpinningChannel& channel = *by_row[row % by_row.size()];
    const double turns = -channel.azimuth_offset_rad / (2.0 * std::numbers::pi);
    const long shift = std::lround(turns * static_cast<double>(columns));
    shifts[row] = static_cast<std::size_t>((shift % columns + columns) % columns);
  }
  return shifts;
}

}  // namespace glidar::ros
