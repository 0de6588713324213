// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_keys.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/io/config/sensor_calibration.hpp>
#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/files/npy_head.hpp>
#include <glidar/io/formats/grey_image_file.hpp>
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

namespace {

constexpr double kDefaultLidarRate_hz = 10.0;

bool is_camera(const Sensor& sensor) {
  return std::holds_alternative<Pinhole>(sensor.optics);
}

void visit_optics(SensorKeys& keys, FieldVisitor& visitor) {
  const auto optics = [&](FieldVisitor& nested) { describe(keys.optics, nested); };
  const bool is_required = !keys.has_table;
  const bool is_present = !(keys.has_table && visitor.is_document());
  if (visitor.is_reading() && keys.has_table) {
    if (visitor.has("optics")) {
      visitor.reject("optics", "given beside a table of beams", "one of the two",
                     "remove one of them");
    }
    return;
  }
  visitor.object({"optics", "the rays, see [optics](optics.md)", kNoUnit, is_required}, is_present,
                 FieldVisitor::Describe(optics));
  if (!visitor.is_reading()) return;
  OpticsSources sources = sources_of(keys.optics);
  keys.sensor.files = std::move(sources.files);
  keys.sensor.notes = std::move(sources.notes);
  keys.sensor.optics = optics_of(std::move(keys.optics));
}

/// Defaults that depend on the optics.
void set_defaults(Sensor& sensor) {
  if (is_camera(sensor)) return;
  sensor.name = "lidar";
  sensor.limits.along = Limits::Along::range;
  const auto* spinning = std::get_if<Spinning>(&sensor.optics);
  sensor.rate_hz = spinning != nullptr ? spinning->rotation_hz : kDefaultLidarRate_hz;
}

/// Runs a check of the sensor. Its error gets the place of a key in the file, and `in` after what
/// was found.
template <class Check>
void check_in_file(const FieldVisitor& visitor, const char* key, const char* in,
                   const Check& check) {
  if (!visitor.is_reading()) return;
  try {
    check();
  } catch (const Error& error) {
    const ErrorParts& parts = error.parts();
    visitor.reject(key, parts.found + in, parts.allowed, parts.remedy);
  }
}

void visit_scan(Sensor& sensor, FieldVisitor& visitor) {
  visitor.number(
      {"rate_hz", "frames per second; of a spinning sensor turns, of a line scanner scans",
       kUnitHertz, false, "30 for cameras, 10 for others, `ouster`: as in its metadata"},
      kAboveZero, sensor.rate_hz);
  check_in_file(visitor, "rate_hz", "", [&] { set_rate(sensor, sensor.rate_hz); });
  visitor.number({"wavelength_nm", "of the light", kUnitNanometre, false, "unknown"},
                 {100.0, 20000.0, false, "nanometres from 100 to 20000"}, sensor.wavelength_m);
  visit_object(visitor, {"limits", "distances that are reported"}, sensor.limits);
}

/// Continuous light, or pulses with what only they have.
void visit_light(Sensor& sensor, FieldVisitor& visitor) {
  visitor.at_most_one({{"lidar_equation", "light"}, "one of light, lidar_equation"});
  for (const char* key : {"footprint", "receiver"}) {
    visitor.needs({key, "lidar_equation", "together with lidar_equation",
                   "add lidar_equation, the range equation, which computes the received signal"});
  }
  const bool is_pulsed = sensor.lidar_equation.has_value();
  const auto light = [&](FieldVisitor& nested) { describe(sensor.light, nested); };
  visitor.object({"light", "Phong light source at the sensor"},
                 !(is_pulsed && visitor.is_document()), FieldVisitor::Describe(light));
  visit_object(visitor, {"lidar_equation", "pulsed light", kNoUnit, false, "none"},
               sensor.lidar_equation);
  visit_object(
      visitor,
      {"footprint", "cross-section of the beam", kNoUnit, false, "an infinitely thin beam"},
      sensor.footprint);
  const auto receiver = [&](FieldVisitor& nested) { describe(sensor.receiver, nested); };
  visitor.object({"receiver", "echoes of pulses"}, is_pulsed, FieldVisitor::Describe(receiver));
}

void visit_weather(Sensor& sensor, FieldVisitor& visitor) {
  visitor.needs({"weather", "lidar_equation", "weather for a sensor with pulsed light",
                 "add 'lidar_equation: ...'"});
  visit_object(visitor, {"weather", "fog, rain and snow", kNoUnit, false, "clear air"},
               sensor.weather);
  const bool is_foggy = sensor.weather && sensor.weather->visibility_m > 0.0;
  if (visitor.is_reading() && is_foggy && !(sensor.wavelength_m > 0.0)) {
    visitor.reject("weather",
                   "a visibility without 'wavelength_nm', on which fog's extinction depends",
                   "fog for light of a known wavelength", "add 'wavelength_nm: ...'");
  }
}

void visit_doppler(Sensor& sensor, FieldVisitor& visitor) {
  visit_object(visitor,
               {"doppler",
                "radial velocity of every return, see [Doppler](../doppler.md); `{}`: without "
                "errors",
                kNoUnit, false, "it is not measured"},
               sensor.doppler);
}

void visit_projector(Sensor& sensor, FieldVisitor& visitor) {
  visitor.at_most_one(
      {{"lidar_equation", "projector_origin_m"}, "a projector of continuous light"});
  Eigen::Vector3d origin_m = sensor.projector_origin_m.value_or(Eigen::Vector3d::Zero());
  const bool is_present =
      visitor.vector({"projector_origin_m", "origin of structured light in the sensor frame",
                      kUnitMetre, false, "none"},
                     {-1e3, 1e3, false, "metres from -1000 to 1000"},
                     sensor.projector_origin_m.has_value(), origin_m);
  if (visitor.is_reading() && is_present) sensor.projector_origin_m = origin_m;
}

/// Loads the picture of a projector.
void load_pattern(Sensor& sensor) {
  auto* stereo = std::get_if<ActiveStereo>(&*sensor.depth_camera);
  if (stereo == nullptr || stereo->projector.picture.empty()) return;
  stereo->projector.pattern = load_grey_image(stereo->projector.picture);
  sensor.files.push_back(stereo->projector.picture);
}

void visit_depth_camera(Sensor& sensor, FieldVisitor& visitor) {
  DepthModel model = sensor.depth_model;
  visit_depth_model(model, visitor);
  visit_object(visitor,
               {"depth_camera",
                "how raw images are measured and depths decoded from them, see "
                "[depth cameras](depth-cameras.md)",
                kNoUnit, false, "none"},
               sensor.depth_camera);
  if (!visitor.is_reading()) return;
  try {
    set_depth_model(model, "depth_model", sensor);
    check_depth_camera(sensor);
  } catch (const Error& error) {
    const ErrorParts& parts = error.parts();
    visitor.reject(visitor.has("depth_camera") ? "depth_camera" : "depth_model", parts.found,
                   parts.allowed, parts.remedy);
  }
  if (sensor.depth_camera) load_pattern(sensor);
}

/// Documents have what was reported when the sensor was read from other files.
void visit_notes(Sensor& sensor, FieldVisitor& visitor) {
  if (visitor.is_report()) return;
  visitor.texts(
      {"notes", "what the program reports when it loads the sensor", kNoUnit, false, "none"},
      sensor.notes);
}

/// Readers of files merge these keys before; only a map inside another file still has them.
void visit_family(FieldVisitor& visitor) {
  const auto visit = [&](const FieldInfo& field, FamilyKey key) {
    if (visitor.is_reading() && visitor.has(field.key)) {
      visitor.reject(field.key, "a family of sensors inside another file",
                     "a sensor file of its own", "write it to a file, and name the file here");
    }
    visitor.family(field, key);
  };
  visit({"variants", "[sensors of a family](sensor-families.md): overrides of the other keys"},
        FamilyKey::overrides);
  visit({"modes", "[settings of the sensor](sensor-families.md): overrides of the other keys"},
        FamilyKey::overrides);
  visit({"default_mode", "the mode that is used if none is chosen"}, FamilyKey::name);
  visit({"aliases", "further names of a preset"}, FamilyKey::names);
}

}  // namespace

SensorKeys sensor_keys(const Sensor& sensor) {
  SensorKeys keys = {.sensor = sensor,
                     .optics = optics_keys(sensor.optics),
                     .has_table = std::holds_alternative<RayTable>(sensor.optics)};
  keys.sensor.optics = {};  // a table can be large, and keys are copied
  return keys;
}

void describe(SensorKeys& keys, FieldVisitor& visitor) {
  Sensor& sensor = keys.sensor;
  if (!visitor.is_reading()) {
    visitor.text(
        {"name", "of the sensor", kNoUnit, false, "`depth camera` for cameras, else `lidar`"},
        sensor.name);
  }
  visit_optics(keys, visitor);
  if (visitor.is_reading()) {
    set_defaults(sensor);
    visitor.text({"name", ""}, sensor.name);
  }
  visit_scan(sensor, visitor);
  visit_light(sensor, visitor);
  check_in_file(visitor, "lidar_equation", " in channel_range_m",
                [&] { check_channel_ranges(sensor); });
  visit_weather(sensor, visitor);
  visit_projector(sensor, visitor);
  visit_doppler(sensor, visitor);
  visit_list(visitor,
             {"noise",
              "noise steps in the order in which the sensor applies them, see "
              "[noise](../noise.md)",
              kNoUnit, false, "none"},
             {0, kMaxNoiseSteps}, "at most 224 steps", sensor.noise);
  check_in_file(visitor, "doppler", "", [&] { check_doppler(sensor); });
  visit_depth_camera(sensor, visitor);
  visitor.boolean(
      {"cull_back_faces", "`true`: beams pass through triangles that are seen from behind"},
      sensor.cull_back_faces);
  visitor.provenance({"source", "where the numbers come from: text for keys of this file"}, true);
  visitor.provenance(
      {"unverified", "keys that were not checked against the manufacturer's documents"}, false);
  visit_notes(sensor, visitor);
  visit_family(visitor);
}

}  // namespace glidar
