// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/cloud_message.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/formats/point_rows.hpp>
#include <glidar/io/packets/hesai.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

namespace glidar::ros {
namespace {

constexpr unsigned kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;

std::size_t digit_of(std::uint32_t time_ns, unsigned shift) {
  return (time_ns >> shift) & (kDigits - 1);
}

}  // namespace

/// Radix sort (Knuth, The Art of Computer Programming 3, 5.2.5, algorithm R): three passes over the
/// points, which is several times faster than comparisons for a cloud of 100,000.
void sort_by_time(std::span<const std::uint32_t> times_ns, std::vector<std::uint32_t>& points) {
  const auto earlier = [&](std::uint32_t a, std::uint32_t b) { return times_ns[a] < times_ns[b]; };
  if (std::is_sorted(points.begin(), points.end(), earlier)) return;
  std::vector<std::uint32_t> sorted(points.size());
  for (unsigned shift = 0; shift < 32; shift += kDigitBits) {
    std::array<std::size_t, kDigits + 1> begin{};
    for (const std::uint32_t point : points) ++begin[digit_of(times_ns[point], shift) + 1];
    for (std::size_t digit = 1; digit < kDigits; ++digit) begin[digit] += begin[digit - 1];
    for (const std::uint32_t point : points)
      sorted[begin[digit_of(times_ns[point], shift)]++] = point;
    std::swap(points, sorted);
  }
}

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

namespace {

[[noreturn]] void reject_cloud(std::string found, std::string allowed) {
  throw Error({"PointCloud2", std::move(found), std::move(allowed), "the message is damaged"});
}

constexpr std::size_t kShown_bytes = 40;

std::string shown_field(const PointField& field) {
  return fmt::format("field '{}'", field.name.shown(kShown_bytes));
}

/// Bytes of one number; 0: unknown.
std::size_t number_bytes(std::uint8_t datatype) {
  constexpr std::array<std::size_t, 9> kBytes = {0, 1, 1, 2, 2, 4, 4, 4, 8};
  return datatype < kBytes.size() ? kBytes[datatype] : 0;
}

/// PCL wrote 0 for 1 in old versions.
std::size_t count_of(const PointField& field) {
  return std::max<std::size_t>(1, field.count);
}

/// Also of clouds without points: each number of a point has a name. `point_step` is not the size
/// of any data then.
void check_fields(const PointCloud2& message) {
  InputBudget budget(message.data.size());
  std::vector<std::pair<std::size_t, std::size_t>> used;  // [begin, end)
  for (const PointField& field : message.fields) {
    budget.take(Budget::components, count_of(field), "PointCloud2");
    budget.take_name(field.name.bytes().size(), "PointCloud2");
    budget.take(Budget::name_bytes, count_of(field) * field.name.bytes().size(), "PointCloud2");
    const std::size_t size = number_bytes(field.datatype) * count_of(field);
    if (size == 0)
      reject_cloud(fmt::format("{} of type {}", shown_field(field), field.datatype),
                   "types 1 to 8");
    if (field.offset > message.point_step || size > message.point_step - field.offset) {
      reject_cloud(fmt::format("{} at {} to {}", shown_field(field), field.offset,
                               std::size_t{field.offset} + size),
                   fmt::format("fields within the {} bytes of a point", message.point_step));
    }
    used.emplace_back(field.offset, field.offset + size);
  }
  std::sort(used.begin(), used.end());
  for (std::size_t i = 1; i < used.size(); ++i) {
    if (used[i].first < used[i - 1].second)
      reject_cloud(fmt::format("two fields at byte {}", used[i].first),
                   "fields that do not overlap");
  }
}

/// Throws Error unless all points are within the data. Every point has at least one byte, so a
/// message of no size cannot claim billions.
void check_sizes(const PointCloud2& message) {
  const std::uint64_t points = std::uint64_t{message.height} * message.width;
  if (points == 0) return;
  const std::uint64_t row = std::uint64_t{message.width} * message.point_step;
  if (message.point_step == 0 || message.row_step < row) {
    reject_cloud(fmt::format("{} points of {} bytes in rows of {}", message.width,
                             message.point_step, message.row_step),
                 "rows that hold their points");
  }
  const std::uint64_t needed = std::uint64_t{message.row_step} * (message.height - 1U) + row;
  if (needed > message.data.size()) {
    reject_cloud(fmt::format("{} bytes of points", message.data.size()),
                 fmt::format("{} bytes, by its sizes", needed));
  }
  if (points > std::numeric_limits<std::uint32_t>::max())
    reject_cloud(fmt::format("{} points", points), "less than 2^32");
}

/// Where the numbers of a field are.
struct FieldView {
  const PointCloud2& message;
  std::span<const std::byte> data;
  std::size_t offset = 0;
  std::size_t count = 1;
};

template <class Stored>
Stored load_number(const std::byte* from, bool is_bigendian) {
  std::array<std::byte, sizeof(Stored)> bytes;
  std::memcpy(bytes.data(), from, bytes.size());
  if (is_bigendian) std::reverse(bytes.begin(), bytes.end());
  Stored value;
  std::memcpy(&value, bytes.data(), bytes.size());
  return value;
}

/// Writes the numbers of all points to `to`, every `stride` numbers.
template <class Stored, class Number>
void copy_numbers(const FieldView& view, Number* to, std::size_t stride) {
  const PointCloud2& message = view.message;
  if (message.width == 0) return;  // a message may claim billions of empty rows
  for (std::uint32_t row = 0; row < message.height; ++row) {
    const std::byte* from = view.data.data() + std::size_t{row} * message.row_step + view.offset;
    for (std::uint32_t col = 0; col < message.width; ++col) {
      for (std::size_t i = 0; i < view.count; ++i)
        to[i] = static_cast<Number>(
            // int8 holds numbers here, not characters. NOLINTNEXTLINE(bugprone-signed-char-misuse)
            load_number<Stored>(from + i * sizeof(Stored), message.is_bigendian));
      from += message.point_step;
      to += stride;
    }
  }
}

template <class Stored, class Number>
void fill_column(const FieldView& view, Column& column) {
  std::vector<Number> values(std::size_t{view.message.height} * view.message.width * view.count);
  copy_numbers<Stored>(view, values.data(), view.count);
  column.values = std::move(values);
}

/// The names of columns and their components, each once.
class NameList {
 public:
  /// Names the column after its field; a number is appended to names that are in use.
  void name(Column& column, const FileText& field, std::size_t count) {
    const std::string wanted = field.column_name();
    std::size_t& number = numbers_[wanted];  // of the last column with this name
    do ++number;
    while (!name(column, number, wanted, count));
    used_.insert(column.name);
    used_.insert(column.components.begin(), column.components.end());
  }

 private:
  /// False if a name is in use.
  bool name(Column& column, std::size_t number, const std::string& wanted, std::size_t count) {
    column.name = number == 1 ? wanted : fmt::format("{}_{}", wanted, number);
    column.components.clear();
    if (!is_free(column.name)) return false;
    for (std::size_t i = 0; i < count; ++i) {
      column.components.push_back(count == 1 ? column.name : fmt::format("{}_{}", column.name, i));
      if (count > 1 && !is_free(column.components.back())) return false;
    }
    return true;
  }

  /// Throws Error after more tries than names need that are not made to collide.
  bool is_free(const std::string& name) {
    constexpr std::size_t kMaxTries = std::size_t{1} << 20U;
    if (++tries_ > kMaxTries)
      reject_cloud(fmt::format("names of fields that collide with others, such as {}", name),
                   "names that differ by more than numbers behind them");
    return !used_.contains(name);
  }

  std::size_t tries_ = 0;
  std::map<std::string, std::size_t> numbers_;
  /// At first those of the points, and of NPZ's other arrays.
  std::set<std::string> used_ = {
      "x",        "y",   "z", "xyz", "world_from_sensor", "world_from_cloud", "world_from_instance",
      "stamp_ns", "seed"};
};

Column column_of(const PointField& field, const FieldView& view, NameList& names) {
  Column column;
  names.name(column, field.name, view.count);
  switch (field.datatype) {
    case PointField::int8:
      fill_column<std::int8_t, std::int64_t>(view, column);
      break;
    case PointField::uint8:
      fill_column<std::uint8_t, std::uint8_t>(view, column);
      break;
    case PointField::int16:
      fill_column<std::int16_t, std::int64_t>(view, column);
      break;
    case PointField::uint16:
      fill_column<std::uint16_t, std::uint16_t>(view, column);
      break;
    case PointField::int32:
      fill_column<std::int32_t, std::int64_t>(view, column);
      break;
    case PointField::uint32:
      fill_column<std::uint32_t, std::uint32_t>(view, column);
      break;
    case PointField::float32:
      fill_column<float, float>(view, column);
      break;
    default:
      fill_column<double, double>(view, column);
  }
  return column;
}

/// 0 to 2 for x, y and z; 3 for others.
std::size_t axis_of(const PointField& field) {
  constexpr std::array<std::string_view, 3> kAxes = {"x", "y", "z"};
  return static_cast<std::size_t>(std::find(kAxes.begin(), kAxes.end(), field.name.bytes()) -
                                  kAxes.begin());
}

void copy_axis(const PointField& field, const FieldView& view, double* to) {
  if (field.datatype == PointField::float32 && view.count == 1)
    return copy_numbers<float>(view, to, 3);
  if (field.datatype == PointField::float64 && view.count == 1)
    return copy_numbers<double>(view, to, 3);
  reject_cloud(fmt::format("{} of type {}", shown_field(field), field.datatype),
               "one float32 or float64 for each coordinate");
}

void require_unique(const PointCloud2& message) {
  std::vector<FileText> names;
  for (const PointField& field : message.fields) names.push_back(field.name);
  std::sort(names.begin(), names.end());
  const auto same = std::adjacent_find(names.begin(), names.end());
  if (same != names.end())
    reject_cloud(fmt::format("two fields '{}'", same->shown(kShown_bytes)), "each name once");
}

}  // namespace

PointCloud to_point_cloud(const PointCloud2& message) {
  check_sizes(message);
  check_fields(message);
  require_unique(message);
  const std::vector<std::byte> copy =
      message.data.bytes().empty() ? message.data.to_vector() : std::vector<std::byte>{};
  const std::span<const std::byte> data = copy.empty() ? message.data.bytes() : copy;
  const std::uint32_t rows = message.width == 0 ? std::min(message.height, 1U) : message.height;
  PointCloud cloud{rows, message.width, message.header.frame_id.shown(), Pose::Identity(), {}};
  std::vector<double> xyz(3 * cloud.size());
  std::size_t axes = 0;
  NameList names;
  cloud.columns.push_back({"xyz", {"x", "y", "z"}, {}});
  for (const PointField& field : message.fields) {
    const FieldView view{message, data, field.offset, count_of(field)};
    const std::size_t axis = axis_of(field);
    if (axis == 3) {
      cloud.columns.push_back(column_of(field, view, names));
      continue;
    }
    copy_axis(field, view, xyz.empty() ? nullptr : xyz.data() + axis);
    ++axes;
  }
  if (axes < 3) reject_cloud("no x, y and z", "all three coordinates");
  cloud.columns.front().values = std::move(xyz);
  return cloud;
}

PointCloud to_point_cloud(const CustomMsg& message) {
  const std::size_t count = message.points.size();
  std::vector<double> xyz;
  xyz.reserve(3 * count);
  std::vector<std::uint32_t> times(count);
  std::vector<std::uint8_t> reflectivity(count);
  std::vector<std::uint8_t> tags(count);
  std::vector<std::uint8_t> lines(count);
  for (std::size_t i = 0; i < count; ++i) {
    const CustomPoint& point = message.points[i];
    xyz.insert(xyz.end(), {double{point.x}, double{point.y}, double{point.z}});
    times[i] = point.offset_time;
    reflectivity[i] = point.reflectivity;
    tags[i] = point.tag;
    lines[i] = point.line;
  }
  PointCloud cloud{
      1, static_cast<std::uint32_t>(count), message.header.frame_id.shown(), Pose::Identity(), {}};
  cloud.columns = {{"xyz", {"x", "y", "z"}, std::move(xyz)},
                   {"offset_time", {"offset_time"}, std::move(times)},
                   {"reflectivity", {"reflectivity"}, std::move(reflectivity)},
                   {"tag", {"tag"}, std::move(tags)},
                   {"line", {"line"}, std::move(lines)}};
  return cloud;
}

}  // namespace glidar::ros
