// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/options/sensor_options.hpp>
#include <apps/glidar/run/console.hpp>
#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/config/imu_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/config/surface_presets.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/pictures/beam_picture.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/portable.hpp>
#include <glidar/sensor/lidar/return_names.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace glidar::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kSurfaceWavelengths_nm = {850, 905, 1064, 1550};

std::array<double, kSurfaceWavelengths_nm.size()> reflectances(const SurfacePreset& surface) {
  std::array<double, kSurfaceWavelengths_nm.size()> values{};
  std::transform(kSurfaceWavelengths_nm.begin(), kSurfaceWavelengths_nm.end(), values.begin(),
                 [&](int nm) { return interpolate(surface.spectrum, nm * 1e-9); });
  return values;
}

Json json_of(const SurfacePreset& surface) {
  Json reflectance = Json::object();
  const auto values = reflectances(surface);
  for (std::size_t k = 0; k < values.size(); ++k) {
    reflectance[std::to_string(kSurfaceWavelengths_nm[k])] = values[k];
  }
  return {{"name", surface.name},
          {"about", surface.about},
          {"reflectance_at_nm", reflectance},
          {"diffuse", std::holds_alternative<Lambert>(surface.backscatter)},
          {"source", surface.source},
          {"verified", surface.verified}};
}

void print_surfaces(const std::vector<SurfacePreset>& surfaces) {
  print("{:<16}", "name");
  for (const int nm : kSurfaceWavelengths_nm) print("{:>6} nm", nm);
  print("  {:<7}  {:<8}  {}\n", "form", "verified", "what it is");
  for (const SurfacePreset& surface : surfaces) {
    print("{:<16}", surface.name);
    for (const double reflectance : reflectances(surface)) print("{:>9.3f}", reflectance);
    const bool is_diffuse = std::holds_alternative<Lambert>(surface.backscatter);
    print("  {:<7}  {:<8}  {}\n", is_diffuse ? "diffuse" : "glossy",
          surface.verified ? "yes" : "no", surface.about);
  }
}

/// Prints the surface presets and their reflectances.
void list_surfaces(bool as_json) {
  const std::vector<SurfacePreset> surfaces = load_surfaces();
  if (!as_json) return print_surfaces(surfaces);
  Json json = Json::array();
  for (const SurfacePreset& surface : surfaces) json.push_back(json_of(surface));
  print_json(json);
}

constexpr double kMicroG_m_s2 = 1e-6 * kStandardGravity_m_s2;

constexpr const char* kUnbacked = "\n* without a source in the manufacturer's documents\n";

/// Values with their sources; those without one are marked.
void print_entries(const std::vector<DatasheetEntry>& entries) {
  for (const DatasheetEntry& entry : entries) {
    print("{}{} = {}\n", entry.verified ? "  " : "* ", entry.key, entry.value);
    if (!entry.source.empty()) print("      {}\n", entry.source);
  }
}

void print_imu_heading() {
  print("{:<12} {:>7} {:>15} {:>15} {:>10} {:>10} {:>9} {:>6}  {}\n", "name", "rate", "gyro noise",
        "accel noise", "gyro bias", "accel bias", "range", "range", "backed");
  print("{:<12} {:>7} {:>15} {:>15} {:>10} {:>10} {:>9} {:>6}\n", "", "Hz", "deg/s/sqrt(Hz)",
        "ug/sqrt(Hz)", "deg/h", "ug", "deg/s", "g");
}

void print_row(const ImuDatasheet& sheet) {
  const Imu& imu = sheet.imu;
  const ValueCount values = count_values(sheet.entries);
  print("{:<12} {:>7g} {:>15.4g} {:>15.4g} {:>10.4g} {:>10.4g} {:>9.4g} {:>6.4g}  {} of {}\n",
        sheet.name, imu.rate_hz, imu.gyroscope.noise_density * kDegreesPerRadian,
        imu.accelerometer.noise_density / kMicroG_m_s2,
        imu.gyroscope.bias_instability * kDegreesPerRadian * 3600.0,
        imu.accelerometer.bias_instability / kMicroG_m_s2, imu.gyroscope.range * kDegreesPerRadian,
        imu.accelerometer.range / kStandardGravity_m_s2, values.backed, values.total);
}

Json json_of(const ImuDatasheet& sheet) {
  const ValueCount values = count_values(sheet.entries);
  return {{"name", sheet.name},
          {"imu", Json::parse(imu_document(sheet.imu))},
          {"values", values.total},
          {"backed", values.backed}};
}

/// Prints the IMU presets as a table, or as JSON.
void list_imus(bool as_json) {
  Json json = Json::array();
  if (!as_json) print_imu_heading();
  for (const std::filesystem::path& file : imu_preset_files()) {
    const ImuDatasheet sheet = load_imu_datasheet(file);
    if (as_json) {
      json.push_back(json_of(sheet));
    } else {
      print_row(sheet);
    }
  }
  if (as_json) print_json(json);
}

/// The file of an IMU preset with this name, in capitals or not.
std::optional<std::filesystem::path> imu_preset_named(const std::string& name) {
  for (const std::filesystem::path& file : imu_preset_files()) {
    if (lower_case(file.stem().string()) == lower_case(name)) return file;
  }
  return std::nullopt;
}

/// Prints an IMU with the sources of its numbers, or as JSON.
void print_imu(const std::filesystem::path& file, bool as_json) {
  const ImuDatasheet sheet = load_imu_datasheet(file);
  if (as_json) return print_json(json_of(sheet));
  print("{}\n\n", sheet.imu.name);
  print_imu_heading();
  print_row(sheet);
  print("\n");
  print_entries(sheet.entries);
  print(kUnbacked);
}

/// A row of the list of sensors.
struct Summary {
  std::string kind;
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  double across_deg = 0.0;
  double upright_deg = 0.0;
  double points_per_s = 0.0;
  ValueCount values;
};

std::string kind_of(const Optics& optics) {
  return std::holds_alternative<Pinhole>(optics) ? "camera" : type_info(optics).name;
}

/// Angle in degrees between the first and the last of `count` pixels, `step` apart, that have a
/// beam.
double span_deg(const Beams& beams, std::size_t first, std::size_t count, std::size_t step) {
  std::vector<Eigen::Vector3d> seen;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d& direction = beams.directions[first + i * step];
    if (!std::isnan(direction.x())) seen.push_back(direction);
  }
  if (seen.empty()) return 0.0;
  const double cosine = std::clamp(seen.front().dot(seen.back()), -1.0, 1.0);
  return 180.0 / std::numbers::pi * portable_acos(cosine);
}

/// For a camera with distortion: between the outermost pixels of its middle row and column.
void measure_view(const Beams& beams, const PinholeIntrinsics& k, Summary& summary) {
  const auto row = static_cast<std::size_t>(std::clamp(k.cy, 0.0, k.height - 1.0));
  const auto col = static_cast<std::size_t>(std::clamp(k.cx, 0.0, k.width - 1.0));
  summary.across_deg = span_deg(beams, row * beams.cols, beams.cols, 1);
  summary.upright_deg = span_deg(beams, col, beams.rows, beams.cols);
}

/// Angles between the outermost beams about the boresight; for a camera between the image edges.
void measure_view(const Sensor& sensor, const Beams& beams, Summary& summary) {
  if (beams.pinhole) {
    summary.across_deg =
        2.0 * kDegreesPerRadian * portable_atan(0.5 * beams.pinhole->width / beams.pinhole->fx);
    summary.upright_deg =
        2.0 * kDegreesPerRadian * portable_atan(0.5 * beams.pinhole->height / beams.pinhole->fy);
    return;
  }
  if (const auto* pinhole = std::get_if<Pinhole>(&sensor.optics)) {
    measure_view(beams, pinhole->intrinsics, summary);
    return;
  }
  const SensorAxes axes = axes_of(beams);
  Eigen::Array2d low(1e9, 1e9);
  Eigen::Array2d high = -low;
  for (const Eigen::Vector3d& d : beams.directions) {
    if (std::isnan(d.x())) continue;
    const Eigen::Array2d angles(azimuth_rad(axes, d), elevation_rad(axes, d));
    low = low.min(angles);
    high = high.max(angles);
  }
  const auto* spinning = std::get_if<Spinning>(&sensor.optics);
  const bool whole_turn =
      spinning != nullptr && spinning->azimuth_width_rad >= 2.0 * std::numbers::pi;
  summary.across_deg = whole_turn ? 360.0 : kDegreesPerRadian * std::max(0.0, high.x() - low.x());
  summary.upright_deg = kDegreesPerRadian * std::max(0.0, high.y() - low.y());
}

Summary summarise_sensor(const Datasheet& sheet, const Beams& beams) {
  Summary summary;
  summary.kind = kind_of(sheet.sensor.optics);
  summary.rows = beams.rows / beams.returns;
  summary.cols = beams.cols;
  summary.points_per_s = static_cast<double>(beams.size()) * sheet.sensor.rate_hz;
  measure_view(sheet.sensor, beams, summary);
  summary.values = count_values(sheet);
  return summary;
}

std::string range_text(const Limits& limits) {
  if (std::isinf(limits.far_m)) return fmt::format("from {:g} m", limits.near_m);
  return fmt::format("{:g}-{:g} m", limits.near_m, limits.far_m);
}

/// Horizontal and vertical divergence, full widths at 1/e^2.
std::string beam_text(const Sensor& sensor) {
  if (!sensor.footprint) return "-";
  return fmt::format("{:.1f} x {:.1f}", 1e3 * sensor.footprint->divergence_x_rad,
                     1e3 * sensor.footprint->divergence_y_rad);
}

std::vector<std::string> returns_of(const Sensor& sensor) {
  std::vector<std::string> names;
  if (!sensor.lidar_equation) return names;
  for (const Return& one : sensor.receiver.returns) names.push_back(return_name(one));
  return names;
}

void print_row(const Datasheet& sheet, const Summary& s) {
  print("{:<22} {:<9} {:>5} x {:<6} {:>5.1f} x {:<6.1f} {:>4g} Hz {:>9.0f} {:>14} {:>11}  {}\n",
        sheet.name, s.kind, s.rows, s.cols, s.across_deg, s.upright_deg, sheet.sensor.rate_hz,
        s.points_per_s, range_text(sheet.sensor.limits), beam_text(sheet.sensor),
        fmt::format("{} of {}", s.values.backed, s.values.total));
}

void print_heading() {
  print("{:<22} {:<9} {:>5} x {:<6} {:>14} {:>7} {:>9} {:>14} {:>11}  {}\n", "name", "kind", "rows",
        "cols", "view, degrees", "rate", "points/s", "range", "beam, mrad", "backed");
}

/// A line with names, of which the chosen one is marked; nothing without names.
void print_names(const char* heading, const std::vector<std::string>& names,
                 const std::string& chosen) {
  if (names.empty()) return;
  print("{}: ", heading);
  for (std::size_t i = 0; i < names.size(); ++i) {
    print("{}{}{}", i > 0 ? ", " : "", names[i], names[i] == chosen ? " (this one)" : "");
  }
  print("\n");
}

void print_sheet(const Datasheet& sheet, const Summary& s) {
  print("{}\n", sheet.sensor.name);
  print_names("aliases", sheet.aliases, "");
  print_names("modes", sheet.modes, sheet.sensor.mode);
  print("\n");
  print_heading();
  print_row(sheet, s);
  print("\n");
  print_entries(sheet.entries);
  if (s.values.backed < s.values.total) {
    print(kUnbacked);
  }
}

/// Horizontal and vertical divergence in mrad; empty without a footprint.
Json divergence_json(const Sensor& sensor) {
  if (!sensor.footprint) return {};
  return {1e3 * sensor.footprint->divergence_x_rad, 1e3 * sensor.footprint->divergence_y_rad};
}

/// The range at which a reflectance is detected with probability 1/2; empty without one.
Json detection_json(const Datasheet& sheet) {
  if (!sheet.sensor.lidar_equation) return {};
  const auto is_documented = [](const DatasheetEntry& entry) {
    return entry.key == "lidar_equation.reference_range_m" && entry.verified &&
           !entry.source.empty();
  };
  return {{"range_m", sheet.sensor.lidar_equation->reference_range_m},
          {"reflectance", sheet.sensor.lidar_equation->reference_reflectance},
          {"documented", std::any_of(sheet.entries.begin(), sheet.entries.end(), is_documented)}};
}

/// Infinite limits become null.
Json json_of(const Datasheet& sheet, const Summary& s) {
  const Limits& limits = sheet.sensor.limits;
  return {{"name", sheet.name},
          {"sensor", sheet.sensor.name},
          {"aliases", sheet.aliases},
          {"modes", sheet.modes},
          {"mode", sheet.sensor.mode},
          {"kind", s.kind},
          {"rows", s.rows},
          {"cols", s.cols},
          {"view_deg", {s.across_deg, s.upright_deg}},
          {"rate_hz", sheet.sensor.rate_hz},
          {"points_per_s", s.points_per_s},
          {"near_m", limits.near_m},
          {"far_m", limits.far_m},
          {"detection", detection_json(sheet)},
          {"divergence_mrad", divergence_json(sheet.sensor)},
          {"returns", returns_of(sheet.sensor)},
          {"values", s.values.total},
          {"backed", s.values.backed}};
}

Json json_of(const std::vector<DatasheetEntry>& entries) {
  Json list = Json::array();
  for (const DatasheetEntry& e : entries) {
    list.push_back(
        {{"key", e.key}, {"value", e.value}, {"source", e.source}, {"verified", e.verified}});
  }
  return list;
}

struct SensorsFlags {
  std::string name;
  std::string mode;
  std::string picture;
  bool surfaces = false;
  bool imus = false;
  bool json = false;
};

int print_surfaces(const SensorsFlags& flags) {
  if (!flags.name.empty() || !flags.picture.empty()) {
    throw Error({.where = "--surfaces",
                 .found = "a sensor or an output is given too",
                 .allowed = "--surfaces alone, or with --json"});
  }
  list_surfaces(flags.json);
  return kDone;
}

/// The image of the pattern is always a PNG.
std::string png_name(const std::string& path) {
  const std::string suffix = lower_case(std::filesystem::path(path).extension().string());
  if (suffix != ".png") refuse_value(path, "a name that ends in .png", "clouds: glidar render");
  return path;
}

int list_presets(const SensorsFlags& flags, const std::vector<SensorPreset>& presets) {
  if (!flags.picture.empty()) {
    throw Error({.where = "-o",
                 .found = "no sensor is given",
                 .remedy = "for example: glidar sensors VLP-16 -o pattern.png"});
  }
  if (!flags.mode.empty()) {
    throw Error({.where = "--mode",
                 .found = "no sensor is given",
                 .remedy = "for example: glidar sensors OS1-128 --mode 2048x10"});
  }
  Json json = Json::array();
  if (!flags.json) print_heading();
  for (const SensorPreset& preset : presets) {
    const Datasheet sheet = load_datasheet(preset.reference);
    const Summary summary = summarise_sensor(sheet, make_beams(sheet.sensor));
    if (flags.json) {
      json.push_back(json_of(sheet, summary));
    } else {
      print_row(sheet, summary);
    }
  }
  if (flags.json) print_json(json);
  return kDone;
}

/// Lists the IMUs, or prints the one that is named; false: neither is requested.
bool print_imus(const SensorsFlags& flags) {
  const auto file = imu_preset_named(flags.name);
  if (!flags.imus && !file) return false;
  const bool is_alone = flags.picture.empty() && !flags.surfaces;
  if (!is_alone || (flags.imus && !flags.name.empty())) {
    throw Error({.where = flags.imus ? "--imus" : flags.name,
                 .found = "a sensor, an output or --surfaces is given too",
                 .allowed = "--imus or the name of an IMU alone, or with --json"});
  }
  if (flags.imus) {
    list_imus(flags.json);
  } else {
    print_imu(*file, flags.json);
  }
  return true;
}

/// Whether the name is that of a file or preset; else it is a part of names.
bool names_one_sensor(const std::string& name) {
  const std::filesystem::path path = split_variant(name).file;
  std::error_code error;
  return path.has_parent_path() || lower_case(path.extension().string()) == ".yaml" ||
         lower_case(path.extension().string()) == ".yml" || preset_named(name).has_value() ||
         std::filesystem::is_regular_file(path, error);
}

/// The sensor with its sources; errors name --mode.
Datasheet load_sheet(const SensorsFlags& flags) {
  Datasheet sheet;
  with_mode_option([&] { sheet = load_datasheet(find_sensor_file(flags.name, flags.mode)); });
  return sheet;
}

int run_sensors(const SensorsFlags& flags) {
  if (print_imus(flags)) return kDone;
  if (flags.surfaces) return print_surfaces(flags);
  if (flags.name.empty()) return list_presets(flags, sensor_presets());
  if (!names_one_sensor(flags.name)) {
    const std::vector<SensorPreset> matching = matching_presets(flags.name);
    if (!matching.empty()) return list_presets(flags, matching);
  }
  const Datasheet sheet = load_sheet(flags);
  const Beams beams = make_beams(sheet.sensor);
  const Summary summary = summarise_sensor(sheet, beams);
  if (flags.json) {
    Json json = json_of(sheet, summary);
    json["numbers"] = json_of(sheet.entries);
    print_json(json);
  } else {
    print_sheet(sheet, summary);
  }
  if (flags.picture.empty()) return kDone;
  refuse_overwrite_of_inputs(sheet.sensor.files, flags.picture);
  write_pattern_picture(beams, flags.picture);
  if (!flags.json) print("\nwrote {}\n", flags.picture);
  return kDone;
}

constexpr const char* kSensorsExamples = R"(Examples:
  glidar sensors
  glidar sensors livox
  glidar sensors VLP-16
  glidar sensors Livox-Mid-40 -o pattern.png
  glidar sensors OS1-128 --mode 2048x10 --json
  glidar sensors --surfaces
  glidar sensors --imus
  glidar sensors BMI088

Use a name with 'glidar render MODEL --sensor NAME'. "backed" counts the values with a source in the
manufacturer's documents (data sheets, manuals, drivers, factory calibrations); the others are
marked *. "beam" is the beam divergence, horizontal x vertical, full width at 1/e^2. Use the name of
a surface with 'glidar render MODEL --surface NAME', and with 'surface:' in scene files; that of an
IMU with '--imu NAME', and with 'imus:' in scene files.
Exit codes: 0 done, 2 no such sensor.)";

}  // namespace

Command add_sensors(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("sensors", "List the sensor presets, or print one with its sources");
  const auto flags = std::make_shared<SensorsFlags>();
  command.footer(kSensorsExamples);
  command
      .add_option("name", flags->name,
                  "Sensor preset, part of its name, or sensor file; or IMU preset")
      ->type_name("NAME");
  const OptionGroup options(command, "Options");
  options.add("--mode", "NAME", "Mode of the sensor, for example 2048x10 [its default mode]",
              flags->mode);
  options.add("-o,--output", "OUT.png", "Image of its beam pattern (PNG)", flags->picture,
              png_name);
  command.add_flag("--surfaces", flags->surfaces,
                   "List the surface presets and their reflectances");
  command.add_flag("--imus", flags->imus, "List the IMU presets");
  command.add_flag("--json", flags->json, "Print JSON instead of a table");
  return [flags] { return run_sensors(*flags); };
}

}  // namespace glidar::app
