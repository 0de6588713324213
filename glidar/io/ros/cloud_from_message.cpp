// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/cloud_from_message.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/input_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>

namespace glidar::ros {
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
