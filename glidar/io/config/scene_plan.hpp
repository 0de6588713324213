// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field_visitor.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/io/config/material_keys.hpp>
#include <glidar/io/config/scene_file.hpp>
#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/io/model/model.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// Names of sensors of the rig in one key.
struct SensorNames {
  std::vector<std::string> names;  ///< empty: the key is missing
  std::string where;               ///< for errors
};

/// Which sensors see an object.
struct Visibility {
  SensorNames visible_to;
  SensorNames hidden_from;
};

/// What becomes objects of their own.
enum class Split : std::uint8_t { none, parts, materials };

/// What an instance changes of parts of its model.
struct PartOverride {
  std::string selector;    ///< a name or pattern of parts, or "material:" and one of materials
  std::string where;       ///< for errors
  std::string class_name;  ///< empty: that of the instance
  std::optional<std::uint32_t> id;
  std::optional<Pose> parent_from_part;
  Visibility visibility;  ///< a key that is missing: that of the instance
  std::vector<MaterialOverride> materials;
};

/// Keys of one entry of `parts` in scene files.
void describe(PartOverride& part, FieldVisitor& visitor);

/// The key `parts`, in the order of the file.
void visit_parts(FieldVisitor& visitor, std::vector<PartOverride>& parts);

/// The key `split`.
void visit_split(FieldVisitor& visitor, Split& split);

/// The keys `visible_to` and `hidden_from`.
void visit_visibility(FieldVisitor& visitor, Visibility& visibility);

/// The key `materials`: changes by the name of a material, those for "*" first.
void visit_materials(FieldVisitor& visitor, std::vector<MaterialOverride>& changes);

/// One entry of `models`.
struct PlannedInstance {
  std::string source;  ///< as load_model() accepts it; relative paths are resolved
  std::string where;   ///< the key `model`, for errors
  ModelOptions options;
  std::string name;                                 ///< unique in the scene
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< along the model's own axes
  Pose world_from_object = Pose::Identity();        ///< at time 0
  std::string poses_file;                 ///< of instances of the same model; empty: there is one
  std::vector<Pose> poses;                ///< of these, relative to that pose; empty: there is one
  std::optional<Trajectory> motion;       ///< empty: stationary
  std::vector<std::string> motion_files;  ///< trajectory files that were read
  std::uint32_t id = 0;
  std::string class_name;                   ///< empty: unlabelled
  std::vector<MaterialOverride> overrides;  ///< those for "*" first
  Split split = Split::none;
  std::vector<PartOverride> parts;  ///< in the order of the file
  Visibility visibility;
};

/// The contents of a scene file, checked, before any model is loaded.
struct ScenePlan {
  ModelOptions defaults;  ///< of models without such keys
  std::vector<PlannedInstance> instances;
  std::vector<RigSensor> sensors;
  std::optional<Pose> world_from_rig;
  bool looks_at = false;                 ///< see SceneFile
  std::optional<Trajectory> rig_motion;  ///< empty: stationary
  std::vector<RigImu> imus;
  Eigen::Vector3d gravity_m_s2 = standard_gravity_m_s2();
  std::vector<std::string> box_classes;  ///< see SceneFile
  std::string where_box_classes;         ///< for errors
  std::vector<std::string> files;  ///< the scene file, and the files that it names except models
};

void describe(PlannedInstance& model, FieldVisitor& visitor);
void describe(ScenePlan& plan, FieldVisitor& visitor);

/// Reads a scene file and the sensor files that it names; loads no model.
ScenePlan read_scene_plan(const std::filesystem::path& path, const ModelOptions& defaults);
/// The same for the contents of such a file; `files` lacks the file itself.
ScenePlan read_scene_plan(const YamlField& root, const ModelOptions& defaults);

/// The sensors of a scene file and where they are: `sensor`, `sensor_pose` and `sensor_motion`, or
/// `sensors`, `rig_pose` and `rig_motion`.
void visit_rig(FieldVisitor& visitor, ScenePlan& plan);

/// The key `name` of something on a rig. Returns its place in the file, for later errors.
std::string visit_rig_name(FieldVisitor& visitor, std::string& name);

using ModelLoader = std::function<Model(const std::string& source, const ModelOptions& options)>;

/// Loads every model once and places its instances, in a scene that may have others. Errors of
/// `load` state their place in the scene file.
SceneFile build_scene(const ScenePlan& plan, const ModelLoader& load, Scene into = {});

}  // namespace glidar
