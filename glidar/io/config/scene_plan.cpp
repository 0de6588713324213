// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/scene_plan.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/core/hits.hpp>
#include <glidar/core/pose_keys.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/config/imu_file.hpp>
#include <glidar/io/config/length_unit.hpp>
#include <glidar/io/config/motion_keys.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_keys.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/formats/trajectory_file.hpp>
#include <glidar/io/model/builtin_models.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace glidar {
namespace {

void visit_names(FieldVisitor& visitor, const FieldInfo& field, SensorNames& sensors) {
  if (visitor.is_writing() && sensors.names.empty()) return;
  visitor.texts(field, sensors.names);
  if (!visitor.is_reading() || !visitor.has(field.key)) return;
  sensors.where = visitor.where(field.key);
  if (sensors.names.empty()) {
    visitor.reject(field.key, "an empty list", "names of sensors of the rig",
                   "leave the key out: all sensors see the object");
  }
}

void visit_id(FieldVisitor& visitor, std::optional<std::uint32_t>& id) {
  if (visitor.is_writing() && !id) return;
  std::uint32_t value = id.value_or(0);
  visitor.whole_number(
      {"id", "unique; clouds contain it", kNoUnit, false, "the next one above all ids"},
      {0, kInvalidId - 1}, value);
  if (visitor.is_reading() && visitor.has("id")) id = value;
}

}  // namespace

void visit_visibility(FieldVisitor& visitor, Visibility& visibility) {
  visit_names(visitor,
              {"visible_to", "only these sensors of the rig see it: a list of names", kNoUnit,
               false, "all"},
              visibility.visible_to);
  visit_names(visitor,
              {"hidden_from", "these sensors of the rig do not see it: a list of names", kNoUnit,
               false, "none"},
              visibility.hidden_from);
}

void visit_materials(FieldVisitor& visitor, std::vector<MaterialOverride>& changes) {
  const auto name = [&](std::size_t i) -> const std::string& { return changes[i].material; };
  const auto add = [&](const std::string& material) { changes.emplace_back().material = material; };
  const auto body = [&](std::size_t i, FieldVisitor& nested) { describe(changes[i], nested); };
  visitor.by_name(
      {"materials", "[changes](materials.md) by the name of a material; `\"*\"`: of all", kNoUnit,
       false, "none"},
      {changes.size(), FunctionRef<const std::string&(std::size_t)>(name),
       FunctionRef<void(const std::string&)>(add)},
      FieldVisitor::DescribeAt(body));
  if (visitor.is_reading()) sort_overrides(changes);
}

void describe(PartOverride& part, FieldVisitor& visitor) {
  if (visitor.is_reading()) part.where = visitor.where("");
  visitor.text({"class", "semantic class", kNoUnit, false, "that of the model"}, part.class_name);
  visit_id(visitor, part.id);
  Pose pose = part.parent_from_part.value_or(Pose::Identity());
  const FieldInfo field = {"pose",
                           "parent_from_part, a [pose](motion.md#poses) that replaces the one in "
                           "the model file; parts below it move with it",
                           kNoUnit, false, "that of the model file"};
  const bool has_pose = visit_pose(visitor, field, part.parent_from_part.has_value(), pose);
  if (visitor.is_reading() && has_pose) part.parent_from_part = pose;
  visit_visibility(visitor, part.visibility);
  visit_materials(visitor, part.materials);
}

void visit_parts(FieldVisitor& visitor, std::vector<PartOverride>& parts) {
  if (visitor.is_writing() && parts.empty()) return;
  const auto name = [&](std::size_t i) -> const std::string& { return parts[i].selector; };
  const auto add = [&](const std::string& selector) { parts.emplace_back().selector = selector; };
  const auto body = [&](std::size_t i, FieldVisitor& nested) { describe(parts[i], nested); };
  visitor.by_name({"parts",
                   "[changes of parts](parts.md) by a name, a pattern such as `arm/*`, "
                   "or `material:NAME`; later ones override earlier ones",
                   kNoUnit, false, "none"},
                  {parts.size(), FunctionRef<const std::string&(std::size_t)>(name),
                   FunctionRef<void(const std::string&)>(add)},
                  FieldVisitor::DescribeAt(body));
}

void visit_split(FieldVisitor& visitor, Split& split) {
  constexpr std::array<Named<Split>, 3> kSplits = {
      {{"none", Split::none}, {"parts", Split::parts}, {"materials", Split::materials}}};
  visit_choice(visitor,
               {"split",
                "makes each part, or each material, an object of its own: consecutive ids, its "
                "name as class"},
               kSplits, split);
}

namespace {

struct RigImuPlan {
  RigImu on_rig;
  std::string file = {};        ///< that it was read from; empty: none
  std::string where_name = {};  ///< for errors
};

/// The IMU of a file or preset; errors state both places.
void load_named_imu(const FieldVisitor& visitor, const char* key, const std::string& name,
                    RigImuPlan& plan) {
  try {
    plan.file = find_imu_file(name).string();
  } catch (const Error& error) {
    const ErrorParts& parts = error.parts();
    visitor.reject(key, parts.found, "a map, " + parts.allowed, parts.remedy);
  }
  try {
    plan.on_rig.imu = load_imu_file(plan.file);
  } catch (const Error& error) {
    reject_at(visitor.where(key), error);
  }
}

/// An IMU: a map, the path of an IMU file, or the name of a preset.
void visit_imu(FieldVisitor& visitor, RigImuPlan& plan) {
  const FieldInfo field = {"imu",
                           "path of an [IMU file](../imu.md), its content as a map, or the name of "
                           "a preset such as `BMI088`",
                           kNoUnit, kRequired};
  std::string name;
  Imu imu = plan.on_rig.imu;
  const auto body = [&](FieldVisitor& nested) { describe(imu, nested); };
  visitor.text_or_object(field, "a map, or the path of an IMU file", name,
                         FieldVisitor::Describe(body));
  if (!visitor.is_reading()) return;
  plan.on_rig.imu = std::move(imu);
  if (name.empty()) return;
  const std::filesystem::path given = name;
  std::string path = name;
  if (given.has_parent_path() || given.has_extension()) visitor.path(field, path);
  load_named_imu(visitor, field.key, path, plan);
}

void describe(RigImuPlan& plan, FieldVisitor& visitor) {
  plan.where_name = visit_rig_name(visitor, plan.on_rig.name);
  visit_imu(visitor, plan);
  visit_pose(visitor,
             {"pose", "rig_from_imu, a [pose](motion.md#poses); of a single sensor sensor_from_imu",
              kNoUnit, false, "identity"},
             true, plan.on_rig.rig_from_imu);
}

/// Names are unique among IMUs and sensors.
void require_unique_names(const std::vector<RigImuPlan>& imus, const ScenePlan& scene) {
  std::vector<std::string> taken;
  for (const RigSensor& sensor : scene.sensors) taken.push_back(sensor.name);
  for (const RigImuPlan& plan : imus) {
    const std::string& name = plan.on_rig.name;
    if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
      throw Error({plan.where_name, "the name '" + name + "' is given twice", "each name once",
                   "choose another name"});
    }
    taken.push_back(name);
  }
}

void visit_gravity(FieldVisitor& visitor, Eigen::Vector3d& gravity_m_s2) {
  visitor.vector({"gravity_m_s2",
                  "`[x, y, z]`: acceleration of free fall in the world, which IMUs measure; "
                  "`[0, 0, 0]` in space",
                  {"m/s²"},
                  false,
                  "`[0, 0, -9.80665]`"},
                 {-1e6, 1e6, false, "a number from -1e6 to 1e6"}, visitor.is_writing(),
                 gravity_m_s2);
}

/// The IMUs of a scene file and the gravity that they measure: `imus` and `gravity_m_s2`. The
/// sensors of the plan are known.
void visit_imus(FieldVisitor& visitor, ScenePlan& plan) {
  std::vector<RigImuPlan> imus;
  for (const RigImu& imu : plan.imus) {
    if (visitor.is_writing()) imus.push_back({imu});
  }
  visit_list(visitor, {"imus", "IMUs on the rig, see [IMUs](../imu.md)", kNoUnit, false, "none"},
             {0, 64}, "at most 64 IMUs", imus);
  visit_gravity(visitor, plan.gravity_m_s2);
  if (!visitor.is_reading()) return;
  require_unique_names(imus, plan);
  for (RigImuPlan& one : imus) {
    if (!one.file.empty()) plan.files.push_back(std::move(one.file));
    plan.imus.push_back(std::move(one.on_rig));
  }
}

namespace fs = std::filesystem;

std::string stem(const std::string& source) {
  if (source.starts_with(kBuiltinPrefix)) {
    const std::string name = source.substr(kBuiltinPrefix.size());
    return name.substr(0, name.find(':'));
  }
  return fs::path(source).stem().string();
}

void visit_options(FieldVisitor& visitor, ModelOptions& options) {
  constexpr std::array<Named<Axis>, 3> kAxes = {{{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}}};
  visit_choice(visitor,
               {"unit", "unit of the model file", kNoUnit, false,
                "`--unit`, else that of the model file, else `m`"},
               kLengthUnits, options.metres_per_unit);
  visit_choice(visitor,
               {"up", "axis of the model file that becomes z", kNoUnit, false,
                "`--up`, else that of the model file, else `z`"},
               kAxes, options.up);
  visitor.boolean({"centre",
                   "`true`: moves the centre of the bounding box to the origin, after `unit` and "
                   "`up`"},
                  options.centre);
  std::vector<std::string> folders;
  if (visitor.is_writing()) {
    for (const fs::path& folder : options.texture_folders) folders.push_back(folder.string());
  }
  visitor.paths({"texture_folder",
                 "a folder, or a list of them, below which "
                 "[textures outside the model's folder](models.md#folders) are searched",
                 kNoUnit, false, "`--texture-folder`, else none"},
                folders);
  if (visitor.is_reading() && visitor.has("texture_folder"))
    options.texture_folders.assign(folders.begin(), folders.end());
}

/// A size of a built-in model, which becomes part of its source. Documents have it there.
void visit_size(FieldVisitor& visitor, const FieldInfo& field, std::size_t max_size,
                std::string& source) {
  if (visitor.is_writing()) return;
  std::vector<double> sizes;
  visitor.numbers(field,
                  {.number = {0.0, kMaxCoordinate_m, true, "metres above 0 and below 1e15"},
                   .min_size = 1,
                   .max_size = max_size,
                   .takes_one = true,
                   .allowed = max_size == 1 ? "a number" : "a number, or a list of 3"},
                  sizes);
  if (!visitor.is_reading() || sizes.empty()) return;
  if (!source.starts_with(kBuiltinPrefix)) {
    visitor.reject(field.key, "given for a model file", "sizes of built-in models alone",
                   "change the size of a model file with 'scale' or 'unit'");
  }
  std::string numbers;
  for (const double size : sizes) numbers += (numbers.empty() ? "" : ",") + number_text(size);
  source += std::string(":") + field.key + "=" + numbers;
}

void visit_sizes(FieldVisitor& visitor, std::string& source) {
  const char* const by_model = "see [models](models.md#built-in-models)";
  visit_size(visitor, {"size", "of a built-in model", kUnitMetre, false, by_model}, 3, source);
  visit_size(visitor, {"radius", "of a built-in model", kUnitMetre, false, by_model}, 1, source);
  visit_size(visitor, {"tube_radius", "of a built-in model", kUnitMetre, false, by_model}, 1,
             source);
}

void visit_scale(FieldVisitor& visitor, Eigen::Vector3d& scale) {
  constexpr const char* kScale = "a number from 1e-15 to 1e15, or its negative, which mirrors";
  std::vector<double> factors = {scale.x(), scale.y(), scale.z()};
  visitor.numbers(
      {"scale", "along the model's own axes: one factor, or `[x, y, z]`", kNoUnit, false, "1"},
      {.number = {-kMaxScale, kMaxScale, false, kScale},
       .min_size = 3,
       .max_size = 3,
       .takes_one = true,
       .allowed = "a list of 3 numbers"},
      factors);
  if (!visitor.is_reading()) return;
  scale = Eigen::Vector3d(factors[0], factors[1], factors[2]);
  if ((scale.cwiseAbs().array() >= kMinScale).all()) return;
  visitor.reject("scale", "a factor of 0, or nearly", kScale);
}

/// Where the model is at time 0, and its class and surface. `motion` follows the other keys.
void visit_attributes(FieldVisitor& visitor, PlannedInstance& model, MotionKeys& motion) {
  const FieldInfo pose = {"pose", "world_from_object at time 0, a [pose](motion.md#poses)", kNoUnit,
                          false, "identity"};
  if (visitor.is_writing() && model.motion) model.world_from_object = start_pose(*model.motion);
  const bool has_pose = visit_pose(visitor, pose, visitor.is_writing(), model.world_from_object);
  if (has_pose) motion.start = model.world_from_object;
  visitor.whole_number(
      {"id", "unique; clouds contain it", kNoUnit, false, "position in the list, from 1"},
      {0, kInvalidId - 1}, model.id);
  visitor.text({"class", "semantic class", kNoUnit, false, "`unlabelled`"}, model.class_name);
  visit_materials(visitor, model.overrides);
  visit_split(visitor, model.split);
  visit_parts(visitor, model.parts);
  visit_visibility(visitor, model.visibility);
}

/// The poses of many instances.
void visit_poses(FieldVisitor& visitor, PlannedInstance& model) {
  visitor.path({"poses",
                "a file of [poses](scenes.md#many-instances) relative to `pose`: an instance of "
                "the model for each",
                kNoUnit, false, "one instance"},
               model.poses_file);
  if (!visitor.is_reading() || model.poses_file.empty()) return;
  for (const char* key : {"motion", "split", "parts"}) {
    if (!visitor.has(key)) continue;
    visitor.reject("poses", std::string("given beside '") + key + "'",
                   "poses of whole objects at rest", "leave one of them out");
  }
  model.poses = load_poses(model.poses_file);
}

/// Names that the file gives are kept; the others get their file's name, with a number if it is
/// taken.
void complete_names(const std::vector<YamlField>& models, std::vector<PlannedInstance>& planned) {
  std::unordered_set<std::string> taken;
  std::unordered_map<std::string, std::uint64_t> counted;  // by file: how many names it has given
  for (std::size_t i = 0; i < models.size(); ++i) {
    const auto field = find(models[i], "name");
    if (!field || taken.insert(planned[i].name).second) continue;
    reject(*field, "the name '" + excerpt(planned[i].name) + "' is given twice", "each name once",
           "choose another name");
  }
  for (PlannedInstance& instance : planned) {
    if (!instance.name.empty()) continue;
    const std::string base = stem(instance.source);
    std::uint64_t& n = counted[base];
    do {
      instance.name = ++n == 1 ? base : base + "_" + std::to_string(n);
    } while (!taken.insert(instance.name).second);
  }
}

/// A model without an id gets its position in the list, counted from 1.
void complete_ids(const std::vector<YamlField>& models, std::vector<PlannedInstance>& planned) {
  std::map<std::uint32_t, std::size_t> taken;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const auto field = find(models[i], "id");
    if (!field) planned[i].id = static_cast<std::uint32_t>(i + 1);
    const auto [other, is_new] = taken.try_emplace(planned[i].id, i);
    if (is_new) continue;
    reject(field ? *field : models[i],
           "id " + std::to_string(planned[i].id) + ", which models[" +
               std::to_string(other->second) + "] has",
           "each id once (without 'id' it is the place in the list, from 1)",
           "give one of them another id");
  }
}

/// The trajectories and textures that the models name.
std::vector<std::string> files_of(const std::vector<PlannedInstance>& instances) {
  std::vector<std::string> files;
  for (const PlannedInstance& one : instances) {
    files.insert(files.end(), one.motion_files.begin(), one.motion_files.end());
    if (!one.poses_file.empty()) files.push_back(one.poses_file);
  }
  const auto add_textures = [&files](const std::vector<MaterialOverride>& changes) {
    for (const MaterialOverride& change : changes) {
      if (!change.noise_texture.empty()) files.push_back(change.noise_texture);
    }
  };
  for (const PlannedInstance& one : instances) {
    add_textures(one.overrides);
    for (const PartOverride& part : one.parts) add_textures(part.materials);
  }
  return files;
}

}  // namespace

void describe(PlannedInstance& model, FieldVisitor& visitor) {
  visitor.path(
      {"model", "a path, or a [built-in model](models.md#built-in-models)", kNoUnit, kRequired},
      model.source);
  if (visitor.is_reading()) model.where = visitor.where("model");
  visitor.text({"name", "unique in the scene", kNoUnit, false,
                "file name without folder and suffix; `_2`, `_3` ... if it is taken"},
               model.name);
  visit_options(visitor, model.options);
  visit_sizes(visitor, model.source);
  visit_scale(visitor, model.scale);
  MotionKeys motion;
  visit_attributes(visitor, model, motion);
  visit_poses(visitor, model);
  if (visitor.is_writing()) motion.trajectory = model.motion;
  const FieldInfo field = {"motion", "[motion](motion.md#motion)", kNoUnit, false, "stationary"};
  if (!visit_motion(visitor, field, motion) || !visitor.is_reading()) return;
  model.motion = std::move(motion.trajectory);
  model.motion_files = std::move(motion.files);
  model.world_from_object = pose_at(*model.motion, 0);
}

void describe(ScenePlan& plan, FieldVisitor& visitor) {
  PlannedInstance model;
  model.options = plan.defaults;
  visit_list(visitor, {"models", "at least one", kNoUnit, kRequired}, {1, 0xFFFFFFFF},
             "at least one model", plan.instances, model);
  if (visitor.is_reading()) plan.files = files_of(plan.instances);
  visit_rig(visitor, plan);
  visit_imus(visitor, plan);
  visitor.texts({"box_classes", "classes whose objects have [boxes](../boxes.md), or `[all]`",
                 kNoUnit, false, "those that are countable"},
                plan.box_classes);
  if (visitor.is_reading()) plan.where_box_classes = visitor.where("box_classes");
}

ScenePlan read_scene_plan(const fs::path& path, const ModelOptions& defaults) {
  ScenePlan plan = read_scene_plan(read_yaml(path), defaults);
  plan.files.insert(plan.files.begin(), path.string());
  return plan;
}

ScenePlan read_scene_plan(const YamlField& root, const ModelOptions& defaults) {
  ScenePlan plan;
  plan.defaults = defaults;
  read_struct(root, plan);
  const std::vector<YamlField> models = items(need(root, "models"));
  complete_names(models, plan.instances);
  complete_ids(models, plan.instances);
  return plan;
}

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
