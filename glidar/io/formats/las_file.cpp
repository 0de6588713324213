// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/las_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/core/version.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/formats/format.hpp>
#include <glidar/io/formats/las_crs.hpp>
#include <glidar/io/formats/las_scan.hpp>
#include <glidar/io/formats/point_rows.hpp>
#include <glidar/math/portable.hpp>
#include <glidar/motion/run_clock.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace glidar {
namespace {

using Coordinates = Eigen::Map<const Eigen::Matrix3Xd>;

constexpr double kMaxCount = std::numeric_limits<std::int32_t>::max();
constexpr int kDefaultStep = -4;  // exponent of 0.1 mm
constexpr double kStepsPerExtent = 1e6;

struct Bounds {
  Eigen::Vector3d low;
  Eigen::Vector3d high;

  [[nodiscard]] double farthest() const {
    return low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff();
  }
  [[nodiscard]] double extent() const {
    const double extent_m = (high - low).maxCoeff();
    return extent_m > 0.0 ? extent_m : farthest();
  }
};

Bounds bounds_of(const std::vector<double>& xyz) {
  const Coordinates points(xyz.data(), 3, static_cast<Eigen::Index>(xyz.size() / 3));
  return {points.rowwise().minCoeff(), points.rowwise().maxCoeff()};
}

/// Exponent of the step for clouds of this extent, without the limit of 32 bits.
int fine_step(double extent_m) {
  constexpr int kMinStep = -22;
  int exponent = kDefaultStep;
  while (exponent > kMinStep && extent_m > 0.0 &&
         power_of_ten(exponent) * kStepsPerExtent > extent_m)
    --exponent;
  return exponent;
}

/// The origin of the counts. Far from 0 it is near the centre of the cloud, at whole metres if
/// these fit, so that numbers are easy to read.
Eigen::Vector3d offset_for(const Bounds& bounds, double scale_m) {
  constexpr double kNear_m = 1e5;
  constexpr double kMaxOff = 1e8;  // steps
  if (bounds.farthest() <= std::min(kNear_m, kMaxCount * scale_m)) return Eigen::Vector3d::Zero();
  const double unit_m = std::min(1.0, kMaxOff * scale_m);
  return ((0.5 * bounds.low + 0.5 * bounds.high) / unit_m).array().round() * unit_m;
}

double reach_m(const Bounds& bounds, const Eigen::Vector3d& offset_m) {
  return std::max((bounds.high - offset_m).maxCoeff(), (offset_m - bounds.low).maxCoeff());
}

/// The grid without counts, in steps of at least the power of ten with this exponent.
LasGrid grid_for(const Bounds& bounds, int exponent) {
  LasGrid grid;
  for (;; ++exponent) {
    grid.scale_m = power_of_ten(exponent);
    grid.offset_m = offset_for(bounds, grid.scale_m);
    if (reach_m(bounds, grid.offset_m) / grid.scale_m + 1.0 <= kMaxCount) return grid;
  }
}

}  // namespace

LasGrid make_las_grid(const std::vector<double>& xyz) {
  if (xyz.empty()) return {.scale_m = power_of_ten(kDefaultStep), .counts = {}};
  const Bounds bounds = bounds_of(xyz);
  return make_las_grid(xyz, grid_for(bounds, fine_step(bounds.extent())));
}

LasGrid make_run_las_grid(const std::vector<double>& xyz) {
  if (xyz.empty()) return make_las_grid(xyz);
  return make_las_grid(xyz, grid_for(bounds_of(xyz), kDefaultStep));
}

LasGrid make_las_grid(const std::vector<double>& xyz, const LasGrid& steps) {
  LasGrid grid{.scale_m = steps.scale_m, .offset_m = steps.offset_m, .counts = {}};
  if (xyz.empty()) return grid;
  const Bounds bounds = bounds_of(xyz);
  if (reach_m(bounds, grid.offset_m) / grid.scale_m + 1.0 > kMaxCount) {
    throw Error({"LAS", "points too far from those of the first frame",
                 fmt::format("{} m in each direction", kMaxCount * grid.scale_m),
                 "write a file for each frame (--per-frame, per_frame=True in Python)"});
  }
  const Coordinates points(xyz.data(), 3, static_cast<Eigen::Index>(xyz.size() / 3));
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<std::uint32_t>& counts = grid.counts[static_cast<std::size_t>(axis)];
    const auto count_of = [&](double x_m) {
      return static_cast<std::int32_t>(std::llround((x_m - grid.offset_m[axis]) / grid.scale_m));
    };
    counts.reserve(static_cast<std::size_t>(points.cols()));
    for (const double x_m : points.row(axis))
      counts.push_back(static_cast<std::uint32_t>(count_of(x_m)));
    grid.min_m[axis] = count_of(bounds.low[axis]) * grid.scale_m + grid.offset_m[axis];
    grid.max_m[axis] = count_of(bounds.high[axis]) * grid.scale_m + grid.offset_m[axis];
  }
  return grid;
}

std::string las_rounding_warning(const std::vector<double>& xyz) {
  if (xyz.empty()) return {};
  const double moved_m = 0.5 * grid_for(bounds_of(xyz), kDefaultStep).scale_m;
  if (moved_m <= kFinePosition_m) return {};
  return fmt::format(
      "LAS stores coordinates in 32 bits, and a cloud of this size in steps of {:g} m, which moves "
      "its points by up to {:g} m; write .npz, .csv or .ply, which store distant points exactly",
      2.0 * moved_m, moved_m);
}

namespace {

struct StandardClass {
  std::string_view name;
  std::uint8_t code;
};

/// Names of classes with the codes of LAS Specification 1.4 R15, table 17.
constexpr StandardClass kStandardClasses[] = {
    {"unclassified", 1},
    {"unlabelled", 1},
    {"ground", 2},
    {"terrain", 2},
    {"soil", 2},
    {"sand", 2},
    {"pavement", 2},
    {"sidewalk", 2},
    {"low_vegetation", 3},
    {"grass", 3},
    {"medium_vegetation", 4},
    {"vegetation", 4},
    {"bush", 4},
    {"shrub", 4},
    {"hedge", 4},
    {"high_vegetation", 5},
    {"tree", 5},
    {"trunk", 5},
    {"building", 6},
    {"house", 6},
    {"roof", 6},
    {"low_noise", 7},
    {"noise", 7},
    {"water", 9},
    {"river", 9},
    {"lake", 9},
    {"rail", 10},
    {"railway", 10},
    {"road", 11},
    {"road_surface", 11},
    {"street", 11},
    {"parking", 11},
    {"wire_guard", 13},
    {"shield_wire", 13},
    {"wire", 14},
    {"wire_conductor", 14},
    {"power_line", 14},
    {"transmission_tower", 15},
    {"pylon", 15},
    {"wire_structure_connector", 16},
    {"insulator", 16},
    {"bridge", 17},
    {"bridge_deck", 17},
    {"high_noise", 18},
    {"overhead_structure", 19},
    {"conveyor", 19},
    {"traffic_light", 19},
    {"ignored_ground", 20},
    {"snow", 21},
};

}  // namespace

std::uint8_t las_standard_class(std::string_view name) {
  std::string word = lower_case(name);
  std::replace_if(
      word.begin(), word.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
  for (const StandardClass& standard : kStandardClasses) {
    if (standard.name == word) return standard.code;
  }
  return 0;
}

std::vector<std::uint8_t> las_class_codes(std::span<const std::string> class_names) {
  constexpr std::size_t kBeforeUser = 63;  // 64 to 255 are user-definable
  std::vector<std::uint8_t> codes;
  for (std::size_t id = 0; id < class_names.size(); ++id) {
    const std::uint8_t standard = las_standard_class(class_names[id]);
    const std::size_t user = kBeforeUser + id;
    const bool fits = id > 0 && user <= std::numeric_limits<std::uint8_t>::max();
    const std::uint8_t other = fits ? static_cast<std::uint8_t>(user) : kLasUnclassified;
    codes.push_back(standard != 0 ? standard : other);
  }
  return codes;
}

}  // namespace glidar

// Sizes and offsets: LAS Specification 1.4 R15, tables 3 (header), 15 (format 6) and 24 (extra
// bytes). All numbers are little-endian.
namespace glidar {
namespace {

constexpr std::size_t kHeaderBytes = 375;
constexpr std::size_t kExtraFieldBytes = 192;
constexpr std::uint8_t kPointFormat = 6;
constexpr std::size_t kMaxReturns = RunTotals::kMaxReturns;
constexpr std::size_t kMaxNameBytes = 31;
constexpr std::uint16_t kStandardTime = 0x01;  // bits of the global encoding
constexpr std::uint16_t kWellKnownText = 0x10;

/// Columns that have a place of their own in a point record.
constexpr std::array<const char*, 3> kOwnPlaces = {"xyz", "intensity", "stamp"};

bool has_own_place(const Column& column) {
  return std::find(kOwnPlaces.begin(), kOwnPlaces.end(), column.name) != kOwnPlaces.end();
}

/// The columns that follow as extra bytes, with their own types.
std::vector<PointField> extra_fields(const PointCloud& cloud) {
  std::vector<PointField> fields;
  for (const Column& column : cloud.columns) {
    if (!has_own_place(column)) append_fields(column, fields);
  }
  return fields;
}

template <class T>
const std::vector<T>* values_of(const PointCloud& cloud, const char* name) {
  const Column* column = find_column(cloud, name);
  return column != nullptr ? std::get_if<std::vector<T>>(&column->values) : nullptr;
}

/// Number of a return within its pulse, counted from 1 by range, and the number of these returns.
struct PulseReturns {
  std::vector<std::uint8_t> number;
  std::vector<std::uint8_t> total;
};

/// The pulse of every point. Beams are repeated once per return, see Beams::returns.
std::vector<std::uint64_t> pulses_of(const CloudFile& job) {
  const auto* rows = values_of<std::uint32_t>(job.cloud, "row");
  const auto* cols = values_of<std::uint32_t>(job.cloud, "col");
  std::vector<std::uint64_t> pulses(job.cloud.size());
  if (rows == nullptr || cols == nullptr) {
    std::iota(pulses.begin(), pulses.end(), std::uint64_t{0});  // a pulse of its own for each
    return pulses;
  }
  const Beams& beams = job.context.beams;
  const std::uint64_t firings = std::max<std::uint64_t>(1, beams.firings());
  for (std::size_t i = 0; i < pulses.size(); ++i)
    pulses[i] = (std::uint64_t{(*rows)[i]} * beams.cols + (*cols)[i]) % firings;
  return pulses;
}

PulseReturns returns_of(const CloudFile& job) {
  const std::vector<std::uint64_t> pulses = pulses_of(job);
  const auto* ranges_m = values_of<double>(job.cloud, "range");
  std::vector<std::size_t> order(pulses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (pulses[a] != pulses[b] || ranges_m == nullptr) return pulses[a] < pulses[b];
    return (*ranges_m)[a] < (*ranges_m)[b];
  });
  PulseReturns returns{std::vector<std::uint8_t>(order.size(), 1),
                       std::vector<std::uint8_t>(order.size(), 1)};
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && pulses[order[end]] == pulses[order[first]]) ++end;
    for (std::size_t k = first; k < end; ++k) {
      returns.number[order[k]] = static_cast<std::uint8_t>(std::min(k - first + 1, kMaxReturns));
      returns.total[order[k]] = static_cast<std::uint8_t>(std::min(end - first, kMaxReturns));
    }
    first = end;
  }
  return returns;
}

constexpr std::int64_t kNanoseconds = 1'000'000'000;
constexpr std::int64_t kLeapSeconds = 18;  // GPS time minus UTC since 2017-01-01

/// Adjusted standard GPS time (less 1e9 s) of a date; else the seconds of the simulation.
double gps_time_s(std::int64_t stamp_ns, bool dates) {
  const std::int64_t shift_ns =
      dates ? (kLeapSeconds - 1'000'000'000) * kNanoseconds - kFirstDate_ns : 0;
  return static_cast<double>(stamp_ns + shift_ns) * 1e-9;
}

std::vector<double> gps_times(const CloudFile& job) {
  std::vector<double> times(job.cloud.size(),
                            gps_time_s(job.frame.stamp_ns, is_date(job.frame.stamp_ns)));
  if (const auto* stamps = values_of<std::int64_t>(job.cloud, "stamp")) {
    std::transform(stamps->begin(), stamps->end(), times.begin(), [&](std::int64_t stamp_ns) {
      return gps_time_s(stamp_ns, is_date(job.frame.stamp_ns));
    });
  }
  return times;
}

std::vector<std::uint16_t> las_intensities(const CloudFile& job) {
  std::vector<std::uint16_t> stored(job.cloud.size(), 0);
  if (find_column(job.cloud, "intensity") == nullptr) return stored;
  const std::vector<float> unit =
      unit_intensities(job.cloud, job.context.sensor, job.context.beams);
  std::transform(unit.begin(), unit.end(), stored.begin(), [](float part) {
    return static_cast<std::uint16_t>(std::lround(part * 65535.0F));
  });
  return stored;
}

/// The codes of classes by the names in the scene; all points are unclassified without classes.
std::vector<std::uint8_t> las_classifications(const CloudFile& job) {
  std::vector<std::uint8_t> stored(job.cloud.size(), kLasUnclassified);
  const auto* classes = values_of<std::uint32_t>(job.cloud, "class");
  if (classes == nullptr) return stored;
  const std::vector<std::uint8_t> codes = las_class_codes(job.context.scene.class_names);
  std::transform(classes->begin(), classes->end(), stored.begin(), [&](std::uint32_t id) {
    return id < codes.size() ? codes[id] : kLasUnclassified;
  });
  return stored;
}

/// The point records as a cloud whose columns are their fields.
PointCloud las_records(const CloudFile& job, LasGrid& grid, const PulseReturns& returns,
                       const LasScan& scan) {
  const std::size_t size = job.cloud.size();
  PointCloud records{job.cloud.rows, job.cloud.cols, job.cloud.frame_id, Pose::Identity(), {}};
  const auto add = [&](const char* name, auto values) {
    records.columns.push_back({name, {name}, std::move(values)});
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    add(std::array{"X", "Y", "Z"}[axis], std::move(grid.counts[axis]));
  add("intensity", las_intensities(job));
  std::vector<std::uint8_t> bits(size);
  for (std::size_t i = 0; i < size; ++i)
    bits[i] = static_cast<std::uint8_t>(returns.number[i] | returns.total[i] << 4U);
  add("returns", std::move(bits));
  add("flags", scan.flags);
  add("classification", las_classifications(job));
  add("user_data", std::vector<std::uint8_t>(size, 0));
  add("scan_angle", std::vector<std::uint16_t>(scan.angles.begin(), scan.angles.end()));
  add("point_source", std::vector<std::uint16_t>(size, 0));
  add("gps_time", gps_times(job));
  return records;
}

/// Appends numbers and texts of fixed size.
class Bytes {
 public:
  template <class T>
  void put(T value) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    text_.append(bytes.data(), bytes.size());
  }
  void put_text(std::string_view text, std::size_t size) {
    text_ += text.substr(0, size);
    text_.append(size - std::min(size, text.size()), '\0');
  }
  void put_zeros(std::size_t count) { text_.append(count, '\0'); }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Type numbers of the extra bytes, table 25.
std::uint8_t extra_type(Stored stored) {
  switch (stored) {
    case Stored::u8:
      return 1;
    case Stored::u16:
      return 3;
    case Stored::u32:
      return 5;
    case Stored::i64:
      return 8;
    case Stored::f32:
      return 9;
    default:
      return 10;
  }
}

void put_vlr_header(Bytes& to, const char* user, std::uint16_t record, std::size_t size,
                    const char* description) {
  to.put(std::uint16_t{0});
  to.put_text(user, 16);
  to.put(record);
  to.put(static_cast<std::uint16_t>(size));
  to.put_text(description, 32);
}

/// The coordinate system in well-known text.
std::string las_coordinate_system(const CloudFile& job) {
  if (!job.options.crs.empty()) return crs_text(job.options.crs);
  std::string frame = printable_line(job.cloud.frame_id);
  std::erase(frame, '"');
  return fmt::format("LOCAL_CS[\"{}\",UNIT[\"metre\",1]]", frame);
}

/// The records between header and points: the coordinate system, and the list of extra fields.
std::string variable_records(const CloudFile& job, std::span<const PointField> extra) {
  const std::string system = las_coordinate_system(job);
  Bytes to;
  put_vlr_header(to, "LASF_Projection", 2112, system.size() + 1, "coordinate system (WKT)");
  to.put_text(system, system.size() + 1);
  if (extra.empty()) return to.text();
  put_vlr_header(to, "LASF_Spec", 4, extra.size() * kExtraFieldBytes, "extra bytes");
  for (const PointField& field : extra) {
    to.put(std::uint16_t{0});
    to.put(extra_type(field.stored));
    to.put(std::uint8_t{0});
    to.put_text(std::string_view(field.name).substr(0, kMaxNameBytes), 32);
    to.put_zeros(kExtraFieldBytes - 36);
  }
  return to.text();
}

std::uint16_t global_encoding(const CloudFile& job) {
  return kWellKnownText | (is_date(job.frame.stamp_ns) ? kStandardTime : 0);
}

/// The header, without a date, so that the same cloud has the same bytes.
std::string las_header(const CloudFile& job, const RunTotals& totals, std::size_t extra_bytes,
                       std::size_t vlr_bytes) {
  constexpr std::size_t kRecordBytes = 30;
  Bytes to;
  to.put_text("LASF", 4);
  to.put(std::uint16_t{0});  // file source
  to.put(global_encoding(job));
  to.put_zeros(16);  // GUID
  to.put(std::uint8_t{1});
  to.put(std::uint8_t{4});
  to.put_text("GLIDAR", 32);
  to.put_text(fmt::format("glidar {}", version()), 32);
  to.put_zeros(4);  // day and year
  to.put(static_cast<std::uint16_t>(kHeaderBytes));
  to.put(static_cast<std::uint32_t>(kHeaderBytes + vlr_bytes));
  to.put(std::uint32_t{extra_bytes == 0 ? 1U : 2U});
  to.put(kPointFormat);
  to.put(static_cast<std::uint16_t>(kRecordBytes + extra_bytes));
  to.put_zeros(24);  // counts of earlier versions
  for (int axis = 0; axis < 3; ++axis) to.put(totals.scale_m);
  for (int axis = 0; axis < 3; ++axis) to.put(totals.offset_m[axis]);
  for (int axis = 0; axis < 3; ++axis) {
    to.put(totals.points > 0 ? totals.max_m[axis] : 0.0);
    to.put(totals.points > 0 ? totals.min_m[axis] : 0.0);
  }
  to.put_zeros(20);  // no waveforms, no extended records
  to.put(static_cast<std::uint64_t>(totals.points));
  for (const std::uint64_t count : totals.of_return) to.put(count);
  return to.text();
}

/// The points in the order of las_order(); `places` are those of its entries in the cloud.
PointCloud in_las_order(const PointCloud& cloud, std::span<const std::uint32_t> places) {
  PointCloud sorted{cloud.rows, cloud.cols, cloud.frame_id, cloud.world_from_cloud, {}};
  sorted.columns.resize(cloud.columns.size());
  for (std::size_t i = 0; i < cloud.columns.size(); ++i)
    select_points(cloud.columns[i], places, sorted.columns[i]);
  return sorted;
}

/// The place of each entry among the entries with a return.
std::vector<std::uint32_t> las_places(std::vector<std::uint32_t> entries) {
  const std::vector<std::uint32_t> order = entries;
  std::ranges::sort(entries);
  std::vector<std::uint32_t> places(order.size());
  std::ranges::transform(order, places.begin(), [&](std::uint32_t entry) {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(entries, entry) - entries.begin());
  });
  return places;
}

void check_crs_frame(const CloudFile& job, const AtomicFile& file) {
  if (job.options.crs.empty() || job.cloud.frame_id == "world") return;
  throw Error(
      {file.path().string(),
       fmt::format("a coordinate reference system for coordinates in {}", job.cloud.frame_id),
       "coordinates in the world's axes", "leave the frame out"});
}

/// The points of a frame as records, and the columns of their extra fields.
struct LasPoints {
  PointCloud cloud;  ///< in the order of the file
  PointCloud records;
};

void count(const LasGrid& grid, const PulseReturns& returns, RunTotals& totals) {
  totals.points += returns.number.size();
  for (const std::uint8_t number : returns.number) ++totals.of_return[number - 1U];
  if (returns.number.empty()) return;
  totals.min_m = totals.min_m.cwiseMin(grid.min_m);
  totals.max_m = totals.max_m.cwiseMax(grid.max_m);
}

/// The first frame with points determines the steps of all.
LasGrid run_grid(const std::vector<double>& xyz, const RunTotals& totals) {
  if (totals.points == 0) return make_run_las_grid(xyz);
  return make_las_grid(xyz, {.scale_m = totals.scale_m, .offset_m = totals.offset_m, .counts = {}});
}

/// The points of the only frame of a file, or of one of many.
LasPoints las_points(const CloudFile& job, bool is_only, RunTotals& totals) {
  const Beams& beams = job.context.beams;
  std::vector<std::uint32_t> order = las_order(job.frame, beams);
  // else decoded from other clouds
  const bool is_measured = !order.empty() && order.size() == job.cloud.size();
  LasPoints points{is_measured ? in_las_order(job.cloud, las_places(order)) : job.cloud, {}};
  const PointCloud& cloud = points.cloud;
  const LasScan scan =
      is_measured ? las_scan(job.frame, beams, job.context.sensor, cloud.world_from_cloud, order)
                  : LasScan{std::vector<std::int16_t>(cloud.size()),
                            std::vector<std::uint8_t>(cloud.size())};
  const CloudFile sorted{cloud, job.frame, job.options, job.context, job.fields};
  const std::vector<double>& xyz = *values_of<double>(cloud, "xyz");
  LasGrid grid = is_only ? make_las_grid(xyz) : run_grid(xyz, totals);
  totals.scale_m = grid.scale_m;
  totals.offset_m = grid.offset_m;
  const PulseReturns returns = returns_of(sorted);
  count(grid, returns, totals);
  points.records = las_records(sorted, grid, returns, scan);
  return points;
}

/// Header and variable records.
std::string las_start(const CloudFile& job, const RunTotals& totals) {
  const std::vector<PointField> extra = extra_fields(job.cloud);
  const std::string variable = variable_records(job, extra);
  return las_header(job, totals, row_bytes(extra), variable.size()) + variable;
}

void write_las_points(const CloudFile& job, const LasPoints& points, AtomicFile& file) {
  std::vector<PointField> fields = native_fields(points.records);
  const std::vector<PointField> extra = extra_fields(points.cloud);
  fields.insert(fields.end(), extra.begin(), extra.end());
  write_binary_rows(fields, points.cloud.size(), file, job.options.progress);
}

void append_las(const CloudFile& job, RunTotals& totals, AtomicFile& file) {
  check_crs_frame(job, file);
  write_las_points(job, las_points(job, false, totals), file);
}

void write_las(const CloudFile& job, AtomicFile& file) {
  check_crs_frame(job, file);
  RunTotals totals;
  const LasPoints points = las_points(job, true, totals);
  file.write(las_start(job, totals));
  write_las_points(job, points, file);
}

std::string las_warning(const PointCloud& cloud) {
  return las_rounding_warning(*values_of<double>(cloud, "xyz"));
}

/// As readers return them: coordinates, then the extra fields.
std::vector<PointField> las_fields(const PointCloud& cloud) {
  std::vector<PointField> fields;
  append_fields(*find_column(cloud, "xyz"), fields);
  const std::vector<PointField> extra = extra_fields(cloud);
  fields.insert(fields.end(), extra.begin(), extra.end());
  return fields;
}

}  // namespace

Format las_format() {
  return {.info = {.suffix = ".las",
                   .description = "LAS 1.4, hits only",
                   .columns = {"xyz", "intensity"},
                   .takes_more = true,
                   .optional_columns = {"range", "row", "col", "stamp", "class"},
                   .is_survey = true},
          .content = Content::hits,
          .fields = las_fields,
          .write = write_las,
          .run_start = las_start,
          .append = append_las,
          .rounding_warning = las_warning};
}

}  // namespace glidar
