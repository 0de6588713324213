// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/cloud_layout.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>
#include <utility>
#include <variant>

namespace glidar {
namespace {

using F32 = std::vector<float>;
using F64 = std::vector<double>;
using U8 = std::vector<std::uint8_t>;
using U16 = std::vector<std::uint16_t>;
using U32 = std::vector<std::uint32_t>;
using Values = std::variant<F32, F64, U8, U16, U32>;

/// One field of a layout: component `component` of a cloud's column, converted.
struct LayoutField {
  std::string name;
  Values type;         ///< an empty vector of it
  std::string column;  ///< of the cloud, kReflectivity or kPackedColour; empty: the field is 0
  std::size_t component = 0;
  double (*convert)(double) = nullptr;
};

struct Layout {
  std::string name;
  std::string whose;
  std::vector<LayoutField> fields;
  int quarter_turns = 0;
};

/// Apparent reflectivity: 1 for a white diffuse surface at normal incidence. See reflectivity().
constexpr const char* kReflectivity = "reflectivity";
/// The bytes of red, green and blue in one number, as PCL packs them.
constexpr const char* kPackedColour = "rgb";

double same(double value) {
  return value;
}

double seconds(double value_ns) {
  return value_ns * 1e-9;
}

/// Of ranges, which apply_layout() has rounded.
double whole_millimetres(double value_mm) {
  return value_mm;
}

/// From 0 to 2 pi.
double whole_turn(double angle_rad) {
  return angle_rad < 0.0 ? angle_rad + 2.0 * std::numbers::pi : angle_rad;
}

constexpr double kMaxByte = 255.0;

/// The byte of a scale; NaN, the reflectivity of a miss, is unchanged.
double byte_on(const IntensityScale& scale, double reflectivity) {
  return std::isnan(reflectivity) ? reflectivity : byte_of_reflectance(scale, reflectivity);
}

/// A byte that is linear up to `white` for a reflectivity of 1 and logarithmic beyond, up to 255
/// for a retro-reflector of 1000. Manufacturers publish `white` and that larger values are
/// retro-reflective, but not the slope.
double reflectivity_byte(double reflectivity, double white) {
  constexpr double kBrightest = 1000.0;
  return byte_on({.kind = IntensityScale::Kind::vendor,
                  .max_reflectance = kBrightest,
                  .diffuse_counts = white},
                 reflectivity);
}

/// 0 to 100 is the percentage of diffuse surfaces: VLP-16 User Manual 63-9243, "Calibrated
/// Reflectivity"; Ouster's firmware manual since 2.1 has the same scale.
double percent_byte(double reflectivity) {
  return reflectivity_byte(reflectivity, 100.0);
}

/// The percentage up to 255 %: PandarXT manual, appendix on the packet's reflectivity.
double linear_percent_byte(double reflectivity) {
  return byte_on({.kind = IntensityScale::Kind::percent}, reflectivity);
}

/// 0 to 150 is 0 to 100 % Lambertian reflection: Livox Avia User Manual, "Output Data".
double livox_byte(double reflectivity) {
  return reflectivity_byte(reflectivity, 150.0);
}

/// Bits 4 and 5: number of the echo, from 0 (Livox Avia User Manual, "Tag Information").
double livox_tag(double number) {
  constexpr double kMaxEchoes = 3.0;
  return 16.0 * std::min(number, kMaxEchoes);
}

/// A sensor's only echo is Autoware's SINGLE_STRONGEST and Nebula's LAST, both 1; 0 is "no return".
double return_type(double status) {
  return status == static_cast<double>(Status::hit) ? 1.0 : 0.0;
}

/// x, y and z, and these fields after them.
std::vector<LayoutField> with_xyz(std::vector<LayoutField> fields) {
  const std::vector<LayoutField> xyz = {
      {"x", F32{}, "xyz", 0, same}, {"y", F32{}, "xyz", 1, same}, {"z", F32{}, "xyz", 2, same}};
  fields.insert(fields.begin(), xyz.begin(), xyz.end());
  return fields;
}

/// The fields of rslidar_sdk and HesaiLidar_ROS_2.0, which are equal.
std::vector<LayoutField> absolute_time_fields(double (*byte_of)(double)) {
  return with_xyz({{"intensity", F32{}, kReflectivity, 0, byte_of},
                   {"ring", U16{}, "ring", 0, same},
                   {"timestamp", F64{}, "stamp", 0, seconds}});
}

/// The fields of both drivers of Ouster; `unused` is always zero.
std::vector<LayoutField> ouster_fields(const LayoutField& ring, const std::string& unused) {
  return with_xyz({{"intensity", F32{}, "intensity", 0, same},
                   {"t", U32{}, "time", 0, same},
                   {"reflectivity", U16{}, kReflectivity, 0, percent_byte},
                   ring,
                   {unused, U16{}, "", 0, nullptr},
                   {"range", U32{}, "range", 0, whole_millimetres}});
}

/// ColorPoint of ouster-ros, of sensors that measure colour.
std::vector<LayoutField> ouster_colour_fields() {
  std::vector<LayoutField> fields = ouster_fields({"ring", U16{}, "ring", 0, same}, "ambient");
  fields.push_back({"rgb", U32{}, kPackedColour, 0, same});
  return fields;
}

/// The sources of each layout are in docs/files/layouts.md.
const std::vector<Layout>& layouts() {
  static const std::vector<Layout> kLayouts = {
      {"minimal", "coordinates", with_xyz({})},
      {"velodyne", "velodyne_pointcloud",
       with_xyz({{"intensity", F32{}, kReflectivity, 0, percent_byte},
                 {"ring", U16{}, "ring", 0, same},
                 {"time", F32{}, "time", 0, seconds}})},
      {"ouster", "ouster-ros", ouster_fields({"ring", U16{}, "ring", 0, same}, "ambient")},
      {"ouster-2022", "Ouster before 2023, LIO-SAM",
       ouster_fields({"ring", U8{}, "ring", 0, same}, "noise")},
      {"livox", "livox_ros_driver2",
       with_xyz({{"intensity", F32{}, kReflectivity, 0, livox_byte},
                 {"tag", U8{}, "return", 0, livox_tag},
                 {"line", U8{}, "ring", 0, same},
                 {"timestamp", F64{}, "stamp", 0, same}})},
      {"livox-custom",
       "livox_ros_driver2, CustomMsg",
       {{"offset_time", U32{}, "time", 0, same},
        {"x", F32{}, "xyz", 0, same},
        {"y", F32{}, "xyz", 1, same},
        {"z", F32{}, "xyz", 2, same},
        {"reflectivity", U8{}, kReflectivity, 0, livox_byte},
        {"tag", U8{}, "return", 0, livox_tag},
        {"line", U8{}, "ring", 0, same}}},
      {"robosense", "rslidar_sdk", absolute_time_fields(percent_byte)},
      {"hesai", "HesaiLidar_ROS_2.0", absolute_time_fields(linear_percent_byte), 1},
      {"autoware", "Autoware",
       with_xyz({{"intensity", U8{}, kReflectivity, 0, percent_byte},
                 {"return_type", U8{}, "status", 0, return_type},
                 {"channel", U16{}, "ring", 0, same},
                 {"azimuth", F32{}, "azimuth", 0, whole_turn},
                 {"elevation", F32{}, "elevation", 0, same},
                 {"distance", F32{}, "range", 0, same},
                 {"time_stamp", U32{}, "time", 0, same}})},
      {"ouster-fast-lio", "FAST-LIO2, lidar_type 3",
       ouster_fields({"ring", U8{}, "ring", 0, same}, "ambient")},
      {"ouster-rgb", "ouster-ros, color_point", ouster_colour_fields()},
      {"robosense-xyzi", "rslidar_sdk as built by default",
       with_xyz({{"intensity", F32{}, kReflectivity, 0, percent_byte}})},
  };
  return kLayouts;
}

/// The cloud columns that the fields need, each once.
std::vector<std::string> columns_of(const Layout& layout) {
  std::vector<std::string> columns;
  const auto need = [&](const std::string& name) {
    if (!name.empty() && std::find(columns.begin(), columns.end(), name) == columns.end())
      columns.push_back(name);
  };
  for (const LayoutField& field : layout.fields) {
    need(field.column == kReflectivity   ? "intensity"
         : field.column == kPackedColour ? "colour"
                                         : field.column);
    if (field.column == kReflectivity) need("range");
  }
  return columns;
}

PointFieldLayout public_layout(const Layout& layout) {
  std::string text = layout.whose + ":";
  for (const LayoutField& field : layout.fields) text += " " + field.name;
  return {layout.name, text, columns_of(layout), layout.quarter_turns};
}

/// Index in layouts() of the layout with this name.
std::size_t place_of(std::string_view name) {
  std::vector<std::string> names;
  for (const Layout& layout : layouts()) {
    if (layout.name == name) return names.size();
    names.push_back(layout.name);
  }
  const std::string near = closest_match(name, names);
  throw Error({"cloud layout", fmt::format("'{}' is not known", excerpt(name)),
               fmt::format("{}", fmt::join(names, " ")),
               near.empty() ? "" : fmt::format("did you mean '{}'?", near)});
}

/// One component of a column; its numbers are exact in double, except times beyond 104 days.
std::vector<double> field_values(const PointCloud& cloud, const Layout& layout,
                                 const std::string& name, std::size_t component) {
  const Column* column = find_column(cloud, name);
  if (column == nullptr) {
    throw Error({"cloud layout " + layout.name, fmt::format("the cloud has no column {}", name),
                 fmt::format("a cloud with {}", fmt::join(columns_of(layout), " ")),
                 "request these columns"});
  }
  const std::size_t step = column->components.size();
  std::vector<double> numbers(cloud.size());
  std::visit(
      [&](const auto& values) {
        for (std::size_t i = 0; i < numbers.size(); ++i)
          numbers[i] = static_cast<double>(values[i * step + component]);
      },
      column->values);
  return numbers;
}

std::vector<double> packed_colours(const PointCloud& cloud, const Layout& layout) {
  std::vector<double> packed(cloud.size(), 0.0);
  for (std::size_t component = 0; component < 3; ++component) {
    const std::vector<double> shares = field_values(cloud, layout, "colour", component);
    for (std::size_t i = 0; i < packed.size(); ++i)
      packed[i] = 256.0 * packed[i] + std::round(kMaxByte * std::clamp(shares[i], 0.0, 1.0));
  }
  return packed;
}

/// How the sensor reports intensity.
struct Spelling {
  bool is_reflectance = false;                 ///< already corrected for range
  const IntensityScale* byte_scale = nullptr;  ///< nullptr: as a number, not as a byte
};

Spelling spelling_of(const Sensor& sensor) {
  Spelling spelling{.is_reflectance = !sensor.lidar_equation.has_value()};
  for (const NoiseStep& step : sensor.noise) {
    const auto* scale = std::get_if<IntensityScale>(&step);
    if (scale == nullptr) continue;
    spelling.is_reflectance = spelling.is_reflectance || scale->reference_m > 0.0;
    if (is_byte_scale(*scale)) spelling = {true, scale};
  }
  return spelling;
}

/// The sensor's own estimate of reflectivity, as manufacturers calibrate it: the signal is
/// corrected for range as in clear air, where sensors are calibrated, but not for incidence and
/// weather. Sensors that report reflectance have done so, and the paper's light hardly depends on
/// range, so its intensity is the reflectivity.
std::vector<double> reflectivity(const PointCloud& cloud, const Layout& layout,
                                 const Sensor& sensor, const Beams& beams) {
  std::vector<double> numbers = field_values(cloud, layout, "intensity", 0);
  const Spelling spelling = spelling_of(sensor);
  if (spelling.byte_scale != nullptr) {
    for (double& number : numbers) number = reflectance_of_byte(*spelling.byte_scale, number);
  }
  if (spelling.is_reflectance) return numbers;
  const std::vector<double> ranges_m = field_values(cloud, layout, "range", 0);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] /= received_signal(*sensor.lidar_equation, 1.0, ranges_m[i] - beams.range_offset_m);
  return numbers;
}

/// The nearest number of the type; NaN becomes 0 in types without NaN.
template <class T>
T nearest(double value) {
  if constexpr (std::is_floating_point_v<T>) {
    return static_cast<T>(value);
  } else {
    constexpr double kMax = std::numeric_limits<T>::max();
    return static_cast<T>(std::round(std::min(std::max(0.0, value), kMax)));  // max(0, NaN) is 0
  }
}

/// Whether the field holds what the sensor itself reports, and this is a byte of its own scale.
bool is_own_byte(const LayoutField& field, const Sensor& sensor) {
  return (field.convert == percent_byte || field.convert == linear_percent_byte) &&
         spelling_of(sensor).byte_scale != nullptr;
}

Column made(const LayoutField& field, const std::vector<double>& numbers, std::size_t count) {
  Column column{field.name, {field.name}, {}};
  std::visit(
      [&](auto values) {
        using T = typename decltype(values)::value_type;
        values.assign(count, T{0});
        for (std::size_t i = 0; i < numbers.size(); ++i)
          values[i] = nearest<T>(field.convert(numbers[i]));
        column.values = std::move(values);
      },
      field.type);
  return column;
}

/// Autoware's codes of two returns state which is stronger and which is nearer, or that both are
/// one; a single return does not contain this.
void check_returns(const Layout& layout, const Beams& beams) {
  if (layout.name != "autoware" || beams.returns == 1) return;
  throw Error({"cloud layout autoware", fmt::format("the sensor reports {} returns", beams.returns),
               "one return of each pulse",
               "measure with the strongest one, or use another layout"});
}

/// Turns the axes of a cloud; all coordinates of layouts are in xyz.
void turn_axes(const Pose& turned_from_cloud, PointCloud& cloud) {
  cloud.world_from_cloud = cloud.world_from_cloud * turned_from_cloud.inverse();
  for (Column& column : cloud.columns) {
    if (column.name != "xyz") continue;
    auto& values = std::get<std::vector<double>>(column.values);
    Eigen::Map<Eigen::Matrix3Xd> points(values.data(), 3, static_cast<Eigen::Index>(cloud.size()));
    points = (turned_from_cloud.linear() * points).eval();
  }
}

/// A layout for unit_intensities().
const Layout& unit_layout() {
  static const Layout kUnit = {"kitti", "KITTI", {{"intensity", F32{}, kReflectivity, 0, same}}};
  return kUnit;
}

}  // namespace

std::vector<float> unit_intensities(const PointCloud& cloud, const Sensor& sensor,
                                    const Beams& beams) {
  const bool has_bytes = spelling_of(sensor).byte_scale != nullptr;
  const bool is_calibrated = sensor.lidar_equation.has_value() && !has_bytes;
  std::vector<double> numbers = is_calibrated ? reflectivity(cloud, unit_layout(), sensor, beams)
                                              : field_values(cloud, unit_layout(), "intensity", 0);
  std::vector<float> shares(numbers.size());
  std::transform(numbers.begin(), numbers.end(), shares.begin(), [&](double number) {
    const double share = is_calibrated ? percent_byte(number) / kMaxByte
                         : has_bytes   ? number / kMaxByte
                                       : number;
    return static_cast<float>(std::clamp(share, 0.0, 1.0));
  });
  return shares;
}

std::vector<std::uint8_t> livox_reflectivities(const PointCloud& cloud, const Sensor& sensor,
                                               const Beams& beams) {
  const std::vector<double> numbers = reflectivity(cloud, unit_layout(), sensor, beams);
  std::vector<std::uint8_t> bytes(numbers.size());
  std::transform(numbers.begin(), numbers.end(), bytes.begin(),
                 [](double number) { return nearest<std::uint8_t>(livox_byte(number)); });
  return bytes;
}

int layout_turns(const std::string& layout) {
  return layout.empty() ? 0 : layouts()[place_of(layout)].quarter_turns;
}

Pose quarter_turned(int turns) {
  Eigen::Matrix3d quarter;
  quarter << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  Pose pose = Pose::Identity();
  for (int i = 0; i < turns; ++i) pose.linear() = quarter * pose.linear().eval();
  return pose;
}

std::span<const PointFieldLayout> cloud_layouts() {
  static const std::vector<PointFieldLayout> kLayouts = [] {
    std::vector<PointFieldLayout> all;
    for (const Layout& layout : layouts()) all.push_back(public_layout(layout));
    return all;
  }();
  return kLayouts;
}

const PointFieldLayout& find_layout(std::string_view name) {
  return cloud_layouts()[place_of(name)];
}

PointCloud apply_layout(const PointCloud& cloud, std::string_view layout, const Sensor& sensor,
                        const Beams& beams) {
  const Layout& wanted = layouts()[place_of(layout)];
  check_returns(wanted, beams);
  if (wanted.quarter_turns != 0 && cloud.frame_id == beams.frame_id) {
    PointCloud turned = cloud;
    turn_axes(quarter_turned(wanted.quarter_turns), turned);
    turned.frame_id += "_" + wanted.name;
    return apply_layout(turned, layout, sensor, beams);
  }
  PointCloud result{cloud.rows, cloud.cols, cloud.frame_id, cloud.world_from_cloud, {}};
  for (LayoutField field : wanted.fields) {
    std::vector<double> numbers;
    if (is_own_byte(field, sensor)) {
      numbers = field_values(cloud, wanted, "intensity", 0);
      field.convert = same;
    } else if (field.column == kReflectivity) {
      numbers = reflectivity(cloud, wanted, sensor, beams);
    } else if (field.column == kPackedColour) {
      numbers = packed_colours(cloud, wanted);
    } else if (!field.column.empty()) {
      numbers = field_values(cloud, wanted, field.column, field.component);
    }
    if (field.convert == whole_millimetres) {
      for (double& number : numbers)
        number = to_whole_units(sensor.limits, Limits::Along::range, number, kMillimetre_m);
    }
    result.columns.push_back(made(field, numbers, cloud.size()));
  }
  return result;
}

}  // namespace glidar
