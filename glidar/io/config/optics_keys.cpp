// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/optics_keys.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/io/config/ray_file.hpp>
#include <glidar/io/config/sensor_calibration.hpp>
#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/io/formats/ouster_file.hpp>

#include <filesystem>
#include <iterator>
#include <type_traits>

namespace glidar {
namespace {

/// Cuts a list of beams into rows of equal length.
void apply_rows(const FieldVisitor& visitor, std::uint32_t rows, RayTable& table) {
  const std::uint32_t size = table.rows * table.cols;
  if (rows > size || size % rows != 0) {
    visitor.reject("rows", "{}", "a divisor of the table's " + std::to_string(size) + " beams");
  }
  table.rows = rows;
  table.cols = size / rows;
}

/// Beams one after the other, whatever times the file has.
void apply_point_time(double point_ns, RayTable& table) {
  const std::size_t size = table.directions.size();
  table.times_ns.resize(size);
  for (std::size_t i = 0; i < size; ++i) table.times_ns[i] = static_cast<double>(i) * point_ns;
  table.period_ns = static_cast<double>(size) * point_ns;
}

RayTable load_rays(const FieldVisitor& visitor, const std::filesystem::path& path) {
  if (path.extension() == ".csv") return load_scan_csv(path);
  if (path.extension() == ".npy") return load_ray_npy(path);
  visitor.reject("file", "{}", "a .csv of times, azimuths and zenith angles, or an .npy of rays");
}

/// The calibration is applied before the keys, unless they have `main_key`, because they may need
/// what it contains, and after them, whose numbers it replaces.
template <class Struct>
void describe_calibrated(CalibratedKeys<Struct>& keys, FieldVisitor& visitor, const char* main_key,
                         CalibrationFiles files) {
  if (visitor.is_writing()) return describe(keys.optics, visitor);
  visit_calibration_files(visitor, files);
  const auto apply = [&] {
    Sensor sensor;
    sensor.optics = keys.optics;
    apply_calibration_files(visitor, files, sensor);
    keys.optics = std::get<Struct>(sensor.optics);
    keys.sources = {sensor.files, sensor.notes};
  };
  if (visitor.is_reading() && !visitor.has(main_key)) apply();
  describe(keys.optics, visitor);
  if (visitor.is_reading()) apply();
}

/// The beams themselves are too many for a sidecar; clouds contain what was measured on them.
void report_table(RayTableKeys& keys, FieldVisitor& visitor) {
  visitor.whole_number({"rows", ""}, {}, keys.table.rows);
  visitor.whole_number({"cols", ""}, {}, keys.table.cols);
  visitor.number({"period_us", "", kUnitMicrosecond_ns}, kFromZero, keys.table.period_ns);
  visitor.boolean({"times", ""}, keys.has_times);
  visitor.boolean({"origins", ""}, keys.has_origins);
}

}  // namespace

void visit_calibration_files(FieldVisitor& visitor, CalibrationFiles& files) {
  visitor.path(files.calibration, files.paths[0]);
  if (files.fire_times.key != nullptr) visitor.path(files.fire_times, files.paths[1]);
}

void apply_calibration_files(const FieldVisitor& visitor, const CalibrationFiles& files,
                             Sensor& sensor) {
  const char* const keys[] = {files.calibration.key, files.fire_times.key};
  for (std::size_t i = 0; i < std::size(keys); ++i) {
    if (files.paths[i].empty()) continue;
    try {
      apply_calibration(files.paths[i], sensor);
    } catch (const Error& error) {
      reject_at(visitor.where(keys[i]), error);
    }
  }
}

OpticsKeys optics_keys(const Optics& optics) {
  return std::visit(
      [](const auto& alternative) -> OpticsKeys {
        if constexpr (std::is_same_v<std::decay_t<decltype(alternative)>, RayTable>) {
          RayTableKeys keys;
          keys.table.rows = alternative.rows;
          keys.table.cols = alternative.cols;
          keys.table.period_ns = alternative.period_ns;
          keys.has_times = !alternative.times_ns.empty();
          keys.has_origins = !alternative.origins_m.empty();
          return keys;
        } else {
          return typename FileForm<std::decay_t<decltype(alternative)>>::type{alternative};
        }
      },
      optics);
}

Optics optics_of(OpticsKeys keys) {
  return std::visit(
      [](auto& alternative) -> Optics {
        using Keys = std::decay_t<decltype(alternative)>;
        if constexpr (std::is_same_v<Keys, RayTableKeys>) {
          return std::move(alternative.table);
        } else if constexpr (std::is_same_v<Keys, OusterKeys>) {
          return std::move(alternative.spinning);
        } else if constexpr (std::is_same_v<Keys, SpinningKeys> ||
                             std::is_same_v<Keys, PinholeKeys>) {
          return std::move(alternative.optics);
        } else {
          return std::move(alternative);
        }
      },
      keys);
}

OpticsSources sources_of(const OpticsKeys& keys) {
  if (const auto* table = std::get_if<RayTableKeys>(&keys)) return {{table->file}, {}};
  if (const auto* ouster = std::get_if<OusterKeys>(&keys)) return {{ouster->file}, ouster->notes};
  if (const auto* spinning = std::get_if<SpinningKeys>(&keys)) return spinning->sources;
  if (const auto* pinhole = std::get_if<PinholeKeys>(&keys)) return pinhole->sources;
  return {};
}

void describe(RayTableKeys& keys, FieldVisitor& visitor) {
  if (visitor.is_report()) return report_table(keys, visitor);
  visitor.path({"file",
                "`.csv`: `Time/s,Azimuth/deg,Zenith/deg` (scan files of the Livox "
                "simulation plugin); `.npy`: N x 3 (directions) or N x 6 (origins in m, "
                "directions), also rows x cols x 3 or 6",
                kNoUnit, kRequired},
               keys.file);
  if (visitor.is_reading()) keys.table = load_rays(visitor, keys.file);
  std::uint32_t rows = keys.table.rows;
  visitor.whole_number({"rows", "rows of the cloud, a divisor of the number of beams", kNoUnit,
                        false, "as in the file"},
                       {1, 0xFFFFFFFF}, rows);
  double point_ns = 0.0;
  visitor.number(
      {"point_us", "time between pulses", kUnitMicrosecond_ns, false, "times of the file"},
      {1e-3, 1e6, false, "microseconds from 0.001 to 1e6"}, point_ns);
  if (!visitor.is_reading()) return;
  if (visitor.has("rows")) apply_rows(visitor, rows, keys.table);
  if (visitor.has("point_us")) apply_point_time(point_ns, keys.table);
}

void describe(OusterKeys& keys, FieldVisitor& visitor) {
  visitor.path({"file", "the metadata JSON of the sensor", kNoUnit, kRequired}, keys.file);
  if (!visitor.is_reading()) return;
  OusterMetadata metadata = load_ouster_metadata(keys.file);
  keys.spinning = std::move(metadata.spinning);
  keys.notes = std::move(metadata.notes);
}

void describe(SpinningKeys& keys, FieldVisitor& visitor) {
  describe_calibrated(
      keys, visitor, "elevation_deg",
      {{"calibration_file",
        "[calibration](spinning.md#calibrations) of one sensor, in a format of its manufacturer; "
        "replaces the numbers that it contains",
        kNoUnit, false, "none"},
       {"fire_time_file", "a second such file: firing times of Hesai", kNoUnit, false, "none"}});
}

void describe(PinholeKeys& keys, FieldVisitor& visitor) {
  describe_calibrated(keys, visitor, "width",
                      {{"calibration_file",
                        "[calibration](optics.md#camera-calibrations) by Kalibr or ROS, in place "
                        "of the size, focal lengths, principal point, skew and distortion",
                        kNoUnit, false, "none"},
                       {}});
}

void describe(OpticsKeys& keys, FieldVisitor& visitor) {
  visit_variant(visitor, {"type", "the kind of optics"}, keys);
}

}  // namespace glidar
