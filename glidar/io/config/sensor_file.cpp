// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_file.hpp>

#include <glidar/io/config/noise_yaml.hpp>
#include <glidar/io/config/optics_yaml.hpp>
#include <glidar/io/config/pulse_yaml.hpp>
#include <glidar/io/config/receiver_yaml.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/config/sensor_yaml.hpp>
#include <glidar/io/config/weather_yaml.hpp>

#include <algorithm>
#include <optional>
#include <utility>

namespace glidar {
namespace {

constexpr double kDefaultLidarRate_hz = 10.0;
constexpr NumberRule kWavelength = {100.0, 20000.0, false, "nanometres from 100 to 20000"};
constexpr NumberRule kPlace_m = {-1e3, 1e3, false, "metres from -1000 to 1000"};

Optics read_optics(const YamlField& field) {
  static const std::vector<std::string> kTypes = {"pinhole", "spinning", "raster",
                                                  "prism",   "table",    "ouster"};
  if (!field.node.IsMap()) reject(field, describe(field), "a map with the key 'type'");
  const auto type = find(field, "type");
  switch (type ? one_of(*type, kTypes) : 0) {
    case 1:
      return read_spinning(field);
    case 2:
      return read_line_scan(field);
    case 3:
      return read_prism(field);
    case 4:
      return read_beam_table(field);
    case 5:
      return read_ouster(field);
    default:
      return read_pinhole(field);
  }
}

bool is_camera(const Sensor& sensor) {
  return std::holds_alternative<Pinhole>(sensor.optics);
}

/// The rate that the optics bring along, or what is usual for their kind.
double usual_rate_hz(const Sensor& sensor) {
  if (const auto* spinning = std::get_if<Spinning>(&sensor.optics)) return spinning->rotation_hz;
  return is_camera(sensor) ? sensor.rate_hz : kDefaultLidarRate_hz;
}

void read_ends(const YamlField& field, Limits& limits) {
  limits.near_m = number_or(field, "near_m", kFromZero, limits.near_m);
  const auto far = find(field, "far_m");
  if (!far) return;
  limits.far_m = number(*far, kAboveZero);
  if (limits.far_m <= limits.near_m) {
    reject(*far, describe(*far) + ", not beyond near_m", "a finite number above near_m");
  }
}

/// `limits`, or `depth_limits` for limits along the depth.
Limits read_limits(const YamlField& sensor_field, const Sensor& sensor) {
  const auto general = find(sensor_field, "limits");
  const auto depth = find(sensor_field, "depth_limits");
  Limits limits;
  limits.along = is_camera(sensor) ? Limits::Along::depth : Limits::Along::range;
  if (general && depth) {
    reject(*depth, "given beside 'limits'", "one of the two", "remove one of them");
  }
  if (depth) {
    require_map(*depth, {"near_m", "far_m"});
    limits.along = Limits::Along::depth;
    read_ends(*depth, limits);
  }
  if (!general) return limits;
  require_map(*general, {"near_m", "far_m", "along"});
  if (const auto along = find(*general, "along")) {
    limits.along =
        one_of(*along, {"depth", "range"}) == 0 ? Limits::Along::depth : Limits::Along::range;
  }
  read_ends(*general, limits);
  return limits;
}

PhongHeadlight read_light(const YamlField& field) {
  require_map(field, {"attenuation", "ambient"});
  PhongHeadlight light;
  light.ambient = number_or(field, "ambient", kFromZero, light.ambient);
  const auto attenuation = find(field, "attenuation");
  if (!attenuation) return light;
  require_map(*attenuation, {"constant", "linear_per_m", "quadratic_per_m2"});
  const auto read = [&](const char* key, double& value) {
    value = number_or(*attenuation, key, kFromZero, value);
  };
  read("constant", light.attenuation_constant);
  read("linear_per_m", light.attenuation_linear_per_m);
  read("quadratic_per_m2", light.attenuation_quadratic_per_m2);
  if (light.attenuation_constant == 0.0 && light.attenuation_linear_per_m == 0.0 &&
      light.attenuation_quadratic_per_m2 == 0.0) {
    reject(*attenuation, "all three are 0", "at least one above 0");
  }
  return light;
}

/// The paper's lamp, or pulses, of which the lamp's light would be no part.
void read_lights(const YamlField& field, Sensor& sensor) {
  const auto light = find(field, "light");
  const auto pulse = find(field, "lidar_equation");
  if (light && pulse) {
    reject(*light, "given beside 'lidar_equation', in whose place it would be",
           "one of light, lidar_equation", "remove one of them");
  }
  if (light) sensor.light = read_light(*light);
  if (pulse) sensor.pulse = read_lidar_equation(*pulse);
}

/// What only a sensor of pulses has.
void read_beam_shape(const YamlField& field, Sensor& sensor) {
  for (const char* key : {"footprint", "receiver"}) {
    const auto value = find(field, key);
    if (value && !sensor.pulse)
      reject(*value, "given without 'lidar_equation'", "together with lidar_equation",
             "add lidar_equation, the range equation that weighs what comes back");
  }
  if (const auto footprint = find(field, "footprint"))
    sensor.footprint = read_footprint(*footprint);
  if (const auto receiver = find(field, "receiver")) sensor.receiver = read_receiver(*receiver);
}

/// Needs the light, on which weather acts.
void read_weather_of(const YamlField& field, Sensor& sensor) {
  sensor.weather = read_weather(field);
  if (!sensor.pulse) {
    reject(field, "given without 'lidar_equation'", "weather for a sensor with pulsed light",
           "add 'lidar_equation: ...'");
  }
  if (sensor.weather->visibility_m > 0.0 && !(sensor.wavelength_m > 0.0)) {
    reject(field, "a visibility without 'wavelength_nm', on which fog's extinction depends",
           "fog for light of a known wavelength", "add 'wavelength_nm: ...'");
  }
}

/// "optics.elevation_deg" and all that it stands under: "optics".
bool covers(const std::string& key, const std::string& path) {
  return path == key || path.starts_with(key + ".") || path.starts_with(key + "[");
}

std::string value_text(const YamlField& field) {
  if (field.node.IsScalar()) return field.node.Scalar();
  if (!field.node.IsSequence()) return describe(field);
  constexpr std::size_t kShown = 8;
  std::string shown;
  const std::size_t count = field.node.size();
  for (std::size_t i = 0; i < count && i < kShown; ++i) {
    if (!field.node[i].IsScalar()) return describe(field);
    shown += (i > 0 ? ", " : "") + field.node[i].Scalar();
  }
  return count > kShown ? shown + ", ... (" + std::to_string(count) + " in all)" : shown;
}

/// The file's values, flat; a list of plain values is one entry.
void add_entries(const YamlField& field, std::vector<DatasheetEntry>& sheet) {
  const bool list_of_maps =
      field.node.IsSequence() && field.node.size() > 0 && !field.node[0].IsScalar();
  if (field.node.IsMap()) {
    for (const auto& [key, value] : entries(field)) {
      const bool told_apart = field.path.empty() && (key == "source" || key == "unverified");
      if (!told_apart) add_entries(value, sheet);
    }
  } else if (list_of_maps) {
    for (const YamlField& item : items(field)) add_entries(item, sheet);
  } else {
    sheet.push_back({field.path, value_text(field), "", true});
  }
}

/// Every key that `source` and `unverified` name must be there: a misspelt one would be lost.
void require_entry(const YamlField& at, const std::string& key,
                   const std::vector<DatasheetEntry>& sheet) {
  const auto covered = [&](const DatasheetEntry& entry) { return covers(key, entry.key); };
  if (std::any_of(sheet.begin(), sheet.end(), covered)) return;
  std::vector<std::string> known;
  for (const DatasheetEntry& entry : sheet) known.push_back(entry.key);
  reject(at, "'" + key + "' is no key of this file", "a key such as optics.elevation_deg",
         suggestion(key, known));
}

void set_source(const std::string& key, const std::string& source,
                std::vector<DatasheetEntry>& sheet) {
  for (DatasheetEntry& entry : sheet) {
    if (covers(key, entry.key)) entry.source = source;
  }
}

void add_sources(const YamlField& root, std::vector<DatasheetEntry>& sheet) {
  const auto sources = find(root, "source");
  if (!sources) return;
  std::vector<std::pair<std::string, std::string>> all;  // no nodes: to assign one changes the file
  for (const auto& [key, value] : entries(*sources)) {
    require_entry(value, key, sheet);
    all.emplace_back(key, text(value));
  }
  // nearer keys win: the long ones come last
  std::stable_sort(all.begin(), all.end(), [](const auto& one, const auto& other) {
    return one.first.size() < other.first.size();
  });
  for (const auto& [key, source] : all) set_source(key, source, sheet);
}

void mark_unverified(const YamlField& root, std::vector<DatasheetEntry>& sheet) {
  const auto unverified = find(root, "unverified");
  if (!unverified) return;
  for (const YamlField& item : items(*unverified)) {
    const std::string key = text(item);
    require_entry(item, key, sheet);
    for (DatasheetEntry& entry : sheet) entry.verified = entry.verified && !covers(key, entry.key);
  }
}

std::vector<DatasheetEntry> read_entries(const YamlField& root) {
  std::vector<DatasheetEntry> sheet;
  add_entries(root, sheet);
  add_sources(root, sheet);
  mark_unverified(root, sheet);
  return sheet;
}

/// Optics from the file, or beams that stand in their place.
void read_or_take_optics(const YamlField& field, std::optional<RayTable> table, Sensor& sensor) {
  if (table) {
    if (const auto optics = find(field, "optics")) {
      reject(*optics, "given beside a table of beams", "one of the two", "remove one of them");
    }
    sensor.optics = *std::move(table);
    return;
  }
  const YamlField optics = need(field, "optics");
  sensor.optics = read_optics(optics);
  if (const auto file = find(optics, "file")) sensor.files.push_back(path_beside(*file));
}

Sensor read_sensor_with(const YamlField& field, std::optional<RayTable> table) {
  require_map(field, {"name", "optics", "rate_hz", "wavelength_nm", "limits", "depth_limits",
                      "light", "lidar_equation", "footprint", "receiver", "weather",
                      "projector_origin_m", "noise", "cull_back_faces", "source", "unverified"});
  Sensor sensor;
  read_or_take_optics(field, std::move(table), sensor);
  if (!is_camera(sensor)) sensor.name = "lidar";
  if (const auto name = find(field, "name")) sensor.name = text(*name);
  set_rate(sensor, number_or(field, "rate_hz", kAboveZero, usual_rate_hz(sensor)));
  if (const auto wavelength = find(field, "wavelength_nm")) {
    sensor.wavelength_m = number(*wavelength, kWavelength) * 1e-9;
  }
  sensor.limits = read_limits(field, sensor);
  read_lights(field, sensor);
  read_beam_shape(field, sensor);
  if (const auto weather = find(field, "weather")) read_weather_of(*weather, sensor);
  if (const auto projector = find(field, "projector_origin_m")) {
    if (sensor.pulse) {
      reject(*projector, "given beside 'lidar_equation'", "a projector of continuous light",
             "remove one of them");
    }
    sensor.projector_origin_m = triple(*projector, kPlace_m);
  }
  if (const auto noise = find(field, "noise")) sensor.noise = read_noise(*noise);
  if (const auto cull = find(field, "cull_back_faces")) sensor.cull_back_faces = boolean(*cull);
  if (find(field, "source") || find(field, "unverified")) {
    YamlField root = field;
    root.path.clear();  // keys count from the sensor's own map
    read_entries(root);
  }
  return sensor;
}

}  // namespace

Sensor read_sensor(const YamlField& field) {
  return read_sensor_with(field, std::nullopt);
}

Sensor load_sensor_file(const std::filesystem::path& path) {
  Sensor sensor = read_sensor(read_yaml(path));
  sensor.files.push_back(path.string());
  return sensor;
}

Sensor parse_sensor(const std::string& text) {
  return read_sensor(read_yaml_text("sensor", text));
}

Sensor parse_sensor(const std::string& text, RayTable table) {
  return read_sensor_with(read_yaml_text("sensor", text), std::move(table));
}

Datasheet load_datasheet(const std::filesystem::path& path) {
  const YamlField root = read_yaml(path);
  return {path.stem().string(), read_sensor(root), read_entries(root)};
}

}  // namespace glidar
