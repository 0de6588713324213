// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/optics_keys.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/io/config/sensor_calibration.hpp>
#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/files/npy_head.hpp>
#include <glidar/io/formats/ouster_file.hpp>
#include <glidar/math/constants.hpp>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>
#include <span>
#include <type_traits>

namespace glidar {
namespace {

namespace fs = std::filesystem;

const TextFileKind kTable = {"a CSV table of beams", 64, ""};  // some million shots
const TextFileKind kRays = {"an NPY array of rays", 512, ""};
constexpr double kMaxTime_s = 100.0 * 24.0 * 3600.0;  // a double holds each nanosecond

[[noreturn]] void fail(const std::string& where, std::string found, std::string allowed,
                       std::string remedy = "") {
  throw Error({where, std::move(found), std::move(allowed), std::move(remedy)});
}

/// Three finite numbers with commas between; nothing when the line has other things.
std::optional<Eigen::Vector3d> three_numbers(std::string_view line) {
  Eigen::Vector3d values;
  const char* at = line.data();
  const char* end = line.data() + line.size();
  for (int i = 0; i < 3; ++i) {
    while (at != end && *at == ' ') ++at;
    const auto [stop, problem] = std::from_chars(at, end, values[i]);
    if (problem != std::errc{} || !std::isfinite(values[i])) return std::nullopt;
    at = stop;
    if (i < 2 && (at == end || *at++ != ',')) return std::nullopt;
  }
  return at == end ? std::optional(values) : std::nullopt;
}

/// Calls visit(line without its end, number from 1) for every line that is not empty.
template <class Visit>
void each_line(std::string_view text, const Visit& visit) {
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    while (line.ends_with('\r') || line.ends_with(' ')) line.remove_suffix(1);
    if (!line.empty()) visit(line, number);
  }
}

/// rows, cols and numbers per ray from a shape.
std::array<std::size_t, 3> ray_shape(const std::string& where, const NpyHead& head) {
  const std::vector<std::size_t>& s = head.shape;
  const bool flat = s.size() == 2;
  const std::array<std::size_t, 3> shape =
      flat ? std::array{std::size_t{1}, s[0], s[1]}
           : (s.size() == 3 ? std::array{s[0], s[1], s[2]} : std::array<std::size_t, 3>{});
  const bool width_fits = shape[2] == 3 || shape[2] == 6;
  if (!width_fits || shape[0] < 1 || shape[1] < 1) {
    fail(where, "an array of another shape",
         "N x 3 (directions), N x 6 (origins, directions), or rows x cols x 3 or 6");
  }
  return shape;
}

Eigen::Vector3d vector_at(const char* data, const NpyHead& head) {
  return {head.number_at(data), head.number_at(data + head.number_bytes),
          head.number_at(data + 2 * head.number_bytes)};
}

}  // namespace

RayTable load_scan_csv(const fs::path& path) {
  const std::string text = read_text_file(path, kTable);
  RayTable table;
  each_line(text, [&](std::string_view line, std::size_t number) {
    const std::optional<Eigen::Vector3d> values = three_numbers(line);
    if (!values) {
      if (number == 1) return;  // the heading
      fail(path.string() + ":" + std::to_string(number), "no three numbers",
           "Time/s,Azimuth/deg,Zenith/deg");
    }
    if (std::abs(values->x()) > kMaxTime_s) {
      fail(path.string() + ":" + std::to_string(number),
           "a time of " + number_text(values->x()) + " s", "times within 100 days of zero",
           "give times in seconds");
    }
    table.times_ns.push_back(values->x() * kSecond_ns);
    table.directions.push_back(direction_at(values->y() * kDegree, (90.0 - values->z()) * kDegree));
  });
  const std::size_t size = table.directions.size();
  if (size < 2) fail(path.string(), "fewer than two shots", "Time/s,Azimuth/deg,Zenith/deg");
  const double first_ns = table.times_ns.front();
  for (double& time_ns : table.times_ns) time_ns -= first_ns;
  for (std::size_t i = 1; i < size; ++i) {
    if (table.times_ns[i] >= table.times_ns[i - 1]) continue;
    fail(path.string(), "the times fall at shot " + std::to_string(i + 1), "times that rise",
         "give 'point_us', the time from shot to shot, to ignore the file's");
  }
  table.rows = 1;
  table.cols = static_cast<std::uint32_t>(size);
  const double last_ns = table.times_ns.back();
  table.period_ns = last_ns + last_ns / static_cast<double>(size - 1);
  if (table.period_ns > kMaxTime_s * kSecond_ns)
    fail(path.string(), "shots over more than 100 days", "100 days in all");
  return table;
}

RayTable load_ray_npy(const fs::path& path) {
  const std::string bytes = read_input_file(path, kRays);
  const NpyHead head = read_npy_head(path.string(), bytes);
  const auto [rows, cols, width] = ray_shape(path.string(), head);
  require_npy_numbers(path.string(), head, bytes);
  RayTable table;
  table.rows = static_cast<std::uint32_t>(rows);
  table.cols = static_cast<std::uint32_t>(cols);
  const char* at = bytes.data() + head.data_at;
  for (std::size_t i = 0; i < rows * cols; ++i, at += width * head.number_bytes) {
    const bool with_origin = width == 6;
    const char* direction = with_origin ? at + 3 * head.number_bytes : at;
    table.directions.push_back(vector_at(direction, head));
    if (with_origin) table.origins_m.push_back(vector_at(at, head));
  }
  return table;
}

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
