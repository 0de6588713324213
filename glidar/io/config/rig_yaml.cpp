// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/rig_yaml.hpp>

#include <glidar/core/excerpt.hpp>
#include <glidar/io/config/motion_yaml.hpp>
#include <glidar/io/config/pose_yaml.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/config/sensor_yaml.hpp>
#include <glidar/io/files/nearest_file.hpp>

#include <algorithm>
#include <cctype>

namespace glidar {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxSensors = 256;
constexpr std::size_t kLongestName = 31;

/// Loads a sensor file that this field names; errors in it are reported with both places.
Sensor load_named_sensor(const YamlField& field, const fs::path& file) {
  try {
    return load_sensor_file(file);
  } catch (const Error& error) {
    reject_at(where(field), error);
  }
}

/// The file of a bundled sensor.
fs::path find_bundled_sensor(const YamlField& field) {
  try {
    return find_sensor_file(field.node.Scalar());
  } catch (const Error& error) {
    const ErrorParts& parts = error.parts();
    reject(field, parts.found, "a map, " + parts.allowed, parts.remedy);
  }
}

/// A sensor: a map, a sensor file, or the name of a bundled sensor.
Sensor read_scene_sensor(const YamlField& field, std::vector<std::string>& files) {
  if (field.node.IsMap()) return read_sensor(field);
  if (!field.node.IsScalar() || field.node.Scalar().empty()) {
    reject(field, content_text(field), "a map, or the path of a sensor file");
  }
  const std::string file = path_beside(field);
  const fs::path named = field.node.Scalar();
  const bool is_name = !named.has_parent_path() && !named.has_extension() && !fs::exists(file);
  if (is_name) return load_named_sensor(field, find_bundled_sensor(field));
  if (!fs::exists(file)) {
    const std::string nearest = nearest_file(file);
    const bool is_near = !nearest.empty() && nearest != fs::path(field.file).filename();
    reject(field, "no such file: " + excerpt(file), "a map, or the path of a sensor file",
           is_near ? "did you mean '" + nearest + "'?"
                   : "paths are relative to the folder of this file");
  }
  files.push_back(file);
  return load_named_sensor(field, file);
}

bool is_plain(char letter) {
  return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '-' || letter == '_';
}

std::string read_name(const YamlField& field, const std::vector<RigSensor>& others) {
  std::string name = text(field);
  if (name.size() > kLongestName || !std::all_of(name.begin(), name.end(), is_plain)) {
    reject(field, "'" + excerpt(name) + "'", "up to 31 letters, digits, - and _",
           "files and topics are named by it");
  }
  const auto is_same = [&](const RigSensor& other) { return other.name == name; };
  if (std::any_of(others.begin(), others.end(), is_same)) {
    reject(field, "the name '" + name + "' is given twice", "each name once",
           "choose another name");
  }
  return name;
}

std::vector<RigSensor> read_sensors(const YamlField& field, std::vector<std::string>& files) {
  const std::vector<YamlField> all = items(field);
  if (all.empty() || all.size() > kMaxSensors) {
    reject(field, std::to_string(all.size()) + " sensors", "1 to 256 sensors");
  }
  std::vector<RigSensor> sensors;
  for (const YamlField& one : all) {
    require_map(one, {"name", "sensor", "pose"});
    RigSensor mounted;
    mounted.name = read_name(need(one, "name"), sensors);
    mounted.sensor = read_scene_sensor(need(one, "sensor"), files);
    if (const auto pose = find(one, "pose")) mounted.rig_from_sensor = read_pose(*pose);
    sensors.push_back(std::move(mounted));
  }
  return sensors;
}

void read_motion_of(const YamlField& root, const std::string& whose, ScenePlan& plan) {
  const auto motion = find(root, whose + "_motion");
  if (!motion) return;
  plan.rig_motion = read_motion(*motion, plan.world_from_rig, plan.files);
  if (!plan.world_from_rig && !std::holds_alternative<TimedPoses>(*plan.rig_motion)) {
    reject(*motion, "the pose at which it starts is missing", "",
           "add '" + whose + "_pose: ...' beside " + whose + "_motion");
  }
  plan.world_from_rig = pose_at(*plan.rig_motion, 0);
}

/// A single sensor has its own pose; several sensors have the pose of their rig.
void check_keys(const YamlField& root, bool has_several) {
  const char* const list = has_several ? "sensors" : "sensor";
  for (const char* key : {"sensor", "sensor_pose", "sensor_motion"}) {
    const auto odd = has_several ? find(root, key) : std::nullopt;
    if (odd) {
      reject(*odd, std::string("given beside '") + list + "'", "sensors, rig_pose, rig_motion",
             "a rig of sensors has poses of its own: rig_pose and the 'pose' of each sensor");
    }
  }
  for (const char* key : {"rig_pose", "rig_motion"}) {
    const auto odd = has_several ? std::nullopt : find(root, key);
    if (odd) {
      reject(*odd, "there are no 'sensors'", "sensor, sensor_pose, sensor_motion",
             "list the sensors of the rig: 'sensors: [{name: ..., sensor: ..., pose: ...}]'");
    }
  }
}

}  // namespace

void read_rig(const YamlField& root, ScenePlan& plan) {
  const auto several = find(root, "sensors");
  check_keys(root, several.has_value());
  if (several) {
    plan.sensors = read_sensors(*several, plan.files);
    if (const auto pose = find(root, "rig_pose")) plan.world_from_rig = read_pose(*pose);
    return read_motion_of(root, "rig", plan);
  }
  if (const auto sensor = find(root, "sensor")) {
    plan.sensors.push_back({.name = "", .sensor = read_scene_sensor(*sensor, plan.files)});
  }
  if (const auto pose = find(root, "sensor_pose")) {
    plan.world_from_rig = read_sensor_pose(*pose);
    plan.looks_at = find(*pose, "look_at").has_value();
  }
  read_motion_of(root, "sensor", plan);
}

}  // namespace glidar
