// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/rig_keys.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/core/pose_keys.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/config/motion_keys.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_keys.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/files/input_file.hpp>

#include <algorithm>
#include <cctype>

namespace glidar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCalibrationText =
    "calibration of this unit: [LiDARs](spinning.md#calibrations), "
    "[cameras](optics.md#camera-calibrations)";
constexpr const char* kFireTimeText = "a second such file: firing times of Hesai";
constexpr const char* kSensorForms = "a map, or the path of a sensor file";

/// A sensor of a scene file, and the file that it was read from.
struct SensorPlan {
  Sensor sensor;
  std::string file;  ///< empty: it is part of the scene file, or a preset
};

/// The keys of a sensor, its mode and its calibration.
struct SensorFields {
  FieldInfo sensor;
  FieldInfo mode;
  CalibrationFiles files;
};

/// A preset.
SensorReference find_preset(const FieldVisitor& visitor, const char* key, const std::string& name) {
  try {
    return find_sensor_file(name);
  } catch (const Error& error) {
    const ErrorParts& parts = error.parts();
    visitor.reject(key, parts.found, "a map, " + parts.allowed, parts.remedy);
  }
}

/// Loads a sensor file; errors state both places.
Sensor load_named_sensor(const FieldVisitor& visitor, const SensorFields& fields,
                         const SensorReference& reference) {
  try {
    return load_sensor_file(reference);
  } catch (const Error& error) {
    const ErrorParts& parts = error.parts();
    if (parts.where == "mode") {
      visitor.reject(fields.mode.key, parts.found, parts.allowed, parts.remedy);
    }
    reject_at(visitor.where(fields.sensor.key), error);
  }
}

[[noreturn]] void reject_missing_file(const FieldVisitor& visitor, const char* key,
                                      const std::string& file) {
  const std::string nearest = nearest_file(file);
  const bool is_near = !nearest.empty() && nearest != fs::path(visitor.file()).filename();
  visitor.reject(key, "no such file: " + excerpt(file), kSensorForms,
                 is_near ? "did you mean '" + nearest + "'?"
                         : "paths are relative to the folder of this file");
}

/// A sensor by the path of its file, FILE#VARIANT, or the name of a preset.
SensorPlan find_sensor(FieldVisitor& visitor, const SensorFields& fields, const fs::path& name,
                       const std::string& mode) {
  const FieldInfo& field = fields.sensor;
  std::string file;
  visitor.path(field, file);
  const bool is_path = name.has_parent_path() || name.has_extension() || fs::exists(file);
  SensorReference reference =
      is_path ? split_variant(file) : find_preset(visitor, field.key, name.string());
  reference.mode = mode;
  if (!is_path) return {load_named_sensor(visitor, fields, reference), ""};
  if (!fs::exists(reference.file)) {
    reject_missing_file(visitor, field.key, reference.file.string());
  }
  return {load_named_sensor(visitor, fields, reference), reference.file.string()};
}

/// A sensor: a map, the path of a sensor file, or the name of a preset. The last two may have a
/// mode. Writers write a map, with the numbers of the mode and of the calibration.
bool visit_sensor(FieldVisitor& visitor, SensorFields fields, bool is_present, SensorPlan& plan) {
  const FieldInfo& field = fields.sensor;
  if (visitor.is_writing() && !is_present) return false;
  SensorKeys keys = visitor.is_writing() ? sensor_keys(plan.sensor) : SensorKeys{};
  std::string name;
  std::string mode;
  const auto body = [&](FieldVisitor& nested) { describe(keys, nested); };
  visitor.text_or_object(field, kSensorForms, name, FieldVisitor::Describe(body));
  if (!visitor.is_writing()) {
    visitor.text(fields.mode, mode);
    visit_calibration_files(visitor, fields.files);
  }
  for (const FieldInfo& key : {fields.mode, fields.files.calibration, fields.files.fire_times})
    visitor.needs({key.key, field.key, "together with a sensor", "add the sensor"});
  if (!visitor.is_reading() || !visitor.has(field.key)) return is_present;
  if (name.empty() && !mode.empty()) {
    visitor.reject(fields.mode.key, "a mode, but the sensor is a map",
                   "a mode of a preset or sensor file", "leave the mode out");
  }
  plan = name.empty() ? SensorPlan{std::move(keys.sensor), ""}
                      : find_sensor(visitor, fields, name, mode);
  apply_calibration_files(visitor, fields.files, plan.sensor);
  return true;
}

struct RigSensorPlan {
  std::string name;
  SensorPlan sensor;
  Pose rig_from_sensor = Pose::Identity();
  std::string where_name = {};  ///< for errors
};

[[noreturn]] void reject_name(const FieldVisitor& visitor, const std::string& name) {
  visitor.reject("name", "'" + excerpt(name) + "'", "up to 31 letters, digits, - and _",
                 "files and topics are named by it");
}

void describe(RigSensorPlan& plan, FieldVisitor& visitor) {
  plan.where_name = visit_rig_name(visitor, plan.name);
  visit_sensor(
      visitor,
      {{"sensor", "as the key `sensor` of a scene", kNoUnit, kRequired},
       {"mode", "[mode](sensor-families.md) of the sensor", kNoUnit, false, "its default mode"},
       {{"calibration_file", kCalibrationText, kNoUnit, false, "none"},
        {"fire_time_file", kFireTimeText, kNoUnit, false, "none"}}},
      true, plan.sensor);
  visit_pose(visitor,
             {"pose", "rig_from_sensor, a [pose](motion.md#poses)", kNoUnit, false, "identity"},
             true, plan.rig_from_sensor);
}

void require_unique_names(const std::vector<RigSensorPlan>& sensors) {
  for (auto one = sensors.begin(); one != sensors.end(); ++one) {
    const auto is_same = [&](const RigSensorPlan& other) { return other.name == one->name; };
    if (std::none_of(sensors.begin(), one, is_same)) continue;
    throw Error({one->where_name, "the name '" + one->name + "' is given twice", "each name once",
                 "choose another name"});
  }
}

/// What the keys of a single sensor, or of a rig, are called and mean.
struct BodyKeys {
  FieldInfo pose;
  FieldInfo motion;
  bool takes_look_at;
  const char* missing_start;  ///< remedy
};

/// Pose and motion of a single sensor, or of the rig.
void visit_body(FieldVisitor& visitor, const BodyKeys& fields, bool is_present, ScenePlan& plan) {
  PoseKeys pose = {.pose = plan.world_from_rig.value_or(Pose::Identity()),
                   .takes_look_at = fields.takes_look_at};
  const bool has_pose = is_present && plan.world_from_rig;
  if (visitor.is_writing() && plan.rig_motion) pose.pose = start_pose(*plan.rig_motion);
  if (visit_pose(visitor, fields.pose, has_pose, pose) && visitor.is_reading()) {
    plan.world_from_rig = pose.pose;
    plan.looks_at = pose.looks_at;
  }
  MotionKeys motion;
  motion.start = plan.world_from_rig;
  if (is_present && visitor.is_writing()) motion.trajectory = plan.rig_motion;
  if (!visit_motion(visitor, fields.motion, motion) || !visitor.is_reading()) return;
  if (!plan.world_from_rig && !std::holds_alternative<TimedPoses>(*motion.trajectory)) {
    visitor.reject(fields.motion.key, "the pose at which it starts is missing", "",
                   fields.missing_start);
  }
  plan.files.insert(plan.files.end(), motion.files.begin(), motion.files.end());
  plan.rig_motion = std::move(motion.trajectory);
  plan.world_from_rig = pose_at(*plan.rig_motion, 0);
}

void add(SensorPlan one, std::string name, const Pose& rig_from_sensor, ScenePlan& plan) {
  if (!one.file.empty()) plan.files.push_back(std::move(one.file));
  plan.sensors.push_back({std::move(name), std::move(one.sensor), rig_from_sensor});
}

/// A single sensor has no name and no pose on a rig.
void visit_single_sensor(FieldVisitor& visitor, bool is_present, ScenePlan& plan) {
  const bool has_sensor = is_present && !plan.sensors.empty();
  SensorPlan sensor;
  if (has_sensor) sensor.sensor = plan.sensors.front().sensor;
  const bool is_given = visit_sensor(
      visitor,
      {{"sensor",
        "path of a [sensor file](sensors.md), its content as a map, or the name of a preset such "
        "as `VLP-16`",
        kNoUnit, false, "none"},
       {"sensor_mode", "[mode](sensor-families.md) of the sensor, such as `2048x10`", kNoUnit,
        false, "its default mode"},
       {{"sensor_calibration_file", kCalibrationText, kNoUnit, false, "none"},
        {"sensor_fire_time_file", kFireTimeText, kNoUnit, false, "none"}}},
      has_sensor, sensor);
  if (visitor.is_reading() && is_given) add(std::move(sensor), "", Pose::Identity(), plan);
  const BodyKeys fields = {
      {"sensor_pose", "world_from_sensor at time 0: a [pose](motion.md#poses), or `{look_at: ...}`",
       kNoUnit, false, "none"},
      {"sensor_motion", "[motion](motion.md#motion) of the sensor, in its own frame", kNoUnit,
       false, "stationary"},
      true,
      "add 'sensor_pose: ...' beside sensor_motion"};
  visit_body(visitor, fields, is_present, plan);
}

void visit_sensors(FieldVisitor& visitor, ScenePlan& plan) {
  std::vector<RigSensorPlan> sensors;
  for (const RigSensor& one : plan.sensors) {
    if (visitor.is_writing()) sensors.push_back({one.name, {one.sensor, ""}, one.rig_from_sensor});
  }
  visit_list(visitor,
             {"sensors", "sensors on one rig, instead of the keys above", kNoUnit, false, "none"},
             {1, 256}, "1 to 256 sensors", sensors);
  if (!visitor.is_reading()) return;
  require_unique_names(sensors);
  for (RigSensorPlan& one : sensors) {
    add(std::move(one.sensor), std::move(one.name), one.rig_from_sensor, plan);
  }
}

}  // namespace

std::string visit_rig_name(FieldVisitor& visitor, std::string& name) {
  constexpr std::size_t kMaxLength = 31;
  const auto is_plain = [](char letter) {
    return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '-' || letter == '_';
  };
  visitor.text(
      {"name", "up to 31 letters, digits, `-` and `_`, unique; part of file names and topics",
       kNoUnit, kRequired},
      name);
  const bool is_fit = name.size() <= kMaxLength && std::all_of(name.begin(), name.end(), is_plain);
  if (visitor.is_reading() && !is_fit) reject_name(visitor, name);
  return visitor.where("name");
}

void visit_rig(FieldVisitor& visitor, ScenePlan& plan) {
  for (const char* key : {"sensor", "sensor_mode", "sensor_calibration_file",
                          "sensor_fire_time_file", "sensor_pose", "sensor_motion"}) {
    visitor.at_most_one({.keys = {"sensors", key},
                         .allowed = "sensors, rig_pose, rig_motion",
                         .conflict_remedy = "a rig of sensors has poses of its own: rig_pose and "
                                            "the 'pose' of each sensor"});
  }
  for (const char* key : {"rig_pose", "rig_motion"}) {
    visitor.needs(
        {key, "sensors", "sensor, sensor_pose, sensor_motion",
         "list the sensors of the rig: 'sensors: [{name: ..., sensor: ..., pose: ...}]'"});
  }
  const bool has_one = plan.sensors.empty() || plan.sensors.front().name.empty();
  visit_single_sensor(visitor, has_one, plan);
  if (visitor.is_writing() && has_one) return;
  visit_sensors(visitor, plan);
  const BodyKeys fields = {
      {"rig_pose", "world_from_rig at time 0: a [pose](motion.md#poses)", kNoUnit, false, "none"},
      {"rig_motion", "[motion](motion.md#motion) of the rig", kNoUnit, false, "stationary"},
      false,
      "add 'rig_pose: ...' beside rig_motion"};
  visit_body(visitor, fields, !has_one, plan);
}

}  // namespace glidar
