// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: a scene file as plain data, and how it becomes a scene.

#include <glidar/io/config/material_keys.hpp>
#include <glidar/io/config/scene_file.hpp>
#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/io/model/model.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// One entry of `models`.
struct PlannedInstance {
  std::string source;  ///< as load_model takes it; relative paths are resolved already
  std::string where;   ///< the field `model`, for errors
  ModelOptions options;
  std::string name;                                 ///< unique in the scene
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< along the model's own axes
  Pose world_from_object = Pose::Identity();
  std::optional<Trajectory> motion;  ///< empty: static
  std::uint32_t id = 0;
  std::string class_name;                   ///< empty: unlabelled
  std::vector<MaterialOverride> overrides;  ///< those for "*" first
};

/// The checked content of a scene file, before any model is loaded.
struct ScenePlan {
  std::vector<PlannedInstance> instances;
  std::vector<RigSensor> sensors;
  std::optional<Pose> world_from_rig;
  bool looks_at = false;                 ///< see SceneFile
  std::optional<Trajectory> rig_motion;  ///< empty: static
  std::vector<std::string> files;        ///< the scene file, and the sensor files it names
};

/// Reads a scene file and the sensor files it names; loads no model.
ScenePlan read_scene_plan(const std::filesystem::path& path, const ModelOptions& defaults);
/// The same for the content of such a file, without its own name among the files.
ScenePlan read_scene_plan(const YamlField& root, const ModelOptions& defaults);

/// The changes under `materials` of a scene file; those for "*" first.
std::vector<MaterialOverride> read_overrides(const YamlField& field);

using ModelLoader = std::function<Model(const std::string& source, const ModelOptions& options)>;

/// Loads every model once and places its instances. Errors of `load` contain their place in
/// the scene file.
Scene build_scene(const ScenePlan& plan, const ModelLoader& load);

}  // namespace glidar
