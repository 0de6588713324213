// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/excerpt.hpp>
#include <glidar/core/hits.hpp>
#include <glidar/io/config/length_unit.hpp>
#include <glidar/io/config/motion_yaml.hpp>
#include <glidar/io/config/pose_yaml.hpp>
#include <glidar/io/config/rig_yaml.hpp>
#include <glidar/io/config/scene_builder.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>
#include <glidar/io/model/builtin_models.hpp>

#include <algorithm>
#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>

namespace glidar {
namespace {

namespace fs = std::filesystem;

constexpr NumberRule kScale = {kMinScale, kMaxScale, false, "a number from 1e-15 to 1e15"};
constexpr NumberRule kSize_m = {0.0, kMaxCoordinate_m, true, "metres above 0 and below 1e15"};

std::string resolved(const YamlField& field) {
  const std::string source = text(field);
  return source.starts_with(kBuiltinPrefix) ? source : path_beside(field);
}

std::string stem(const std::string& source) {
  if (source.starts_with(kBuiltinPrefix)) {
    const std::string name = source.substr(kBuiltinPrefix.size());
    return name.substr(0, name.find(':'));
  }
  return fs::path(source).stem().string();
}

ModelOptions read_options(const YamlField& model, const ModelOptions& defaults) {
  ModelOptions options = defaults;
  if (const auto unit = find(model, "unit")) {
    options.metres_per_unit = kLengthUnits[one_of(*unit, length_unit_names())].metres;
  }
  if (const auto up = find(model, "up")) {
    options.up = static_cast<Axis>(one_of(*up, {"x", "y", "z"}));
  }
  if (const auto centre = find(model, "centre")) options.centre = boolean(*centre);
  return options;
}

/// One factor, or one for each of the model's own axes.
Eigen::Vector3d read_scale(const YamlField& field) {
  if (field.node.IsSequence()) return triple(field, kScale);
  return Eigen::Vector3d::Constant(number(field, kScale));
}

/// A size of a built-in model as its source names it.
std::string size_text(const YamlField& field) {
  if (!field.node.IsSequence()) return number_text(number(field, kSize_m));
  std::string numbers;
  for (const YamlField& one : items(field)) {
    numbers += (numbers.empty() ? "" : ",") + number_text(number(one, kSize_m));
  }
  return numbers;
}

/// The model's source with the sizes that a built-in model is given beside its name.
std::string read_source(const YamlField& field) {
  const YamlField model = need(field, "model");
  std::string source = resolved(model);
  for (const char* key : {"size", "radius", "tube_radius"}) {
    const auto size = find(field, key);
    if (!size) continue;
    if (!source.starts_with(kBuiltinPrefix)) {
      reject(*size, "given for a model file", "sizes of built-in models alone",
             "change the size of a model file with 'scale' or 'unit'");
    }
    source += std::string(":") + key + "=" + size_text(*size);
  }
  return source;
}

MaterialOverride read_override(const std::string& material, const YamlField& field) {
  MaterialOverride change;
  change.material = material;
  change.where = where(field);
  read_struct(field, change);
  if (const auto texture = find(field, "noise_texture")) {
    change.where_noise_texture = where(*texture);
  }
  return change;
}

/// Where the model is at time 0, and how it moves.
void read_placing(const YamlField& field, PlannedInstance& planned,
                  std::vector<std::string>& files) {
  std::optional<Pose> start;
  if (const auto pose = find(field, "pose")) start = read_pose(*pose);
  planned.world_from_object = start.value_or(Pose::Identity());
  const auto motion = find(field, "motion");
  if (!motion) return;
  planned.motion = read_motion(*motion, start, files);
  planned.world_from_object = pose_at(*planned.motion, 0);
}

PlannedInstance read_model(const YamlField& field, const ModelOptions& defaults,
                           std::vector<std::string>& files) {
  require_map(field, {"model", "name", "unit", "up", "centre", "size", "radius", "tube_radius",
                      "scale", "pose", "id", "class", "materials", "motion"});
  PlannedInstance planned;
  planned.source = read_source(field);
  planned.where = where(need(field, "model"));
  planned.options = read_options(field, defaults);
  if (const auto scale = find(field, "scale")) planned.scale = read_scale(*scale);
  read_placing(field, planned, files);
  if (const auto name = find(field, "class")) planned.class_name = text(*name);
  if (const auto materials = find(field, "materials")) {
    planned.overrides = read_overrides(*materials);
  }
  return planned;
}

/// Keeps names given in the file; the others get the name of their model file, with a number where
/// it is taken.
void read_names(const std::vector<YamlField>& models, std::vector<PlannedInstance>& planned) {
  std::unordered_set<std::string> taken;
  std::unordered_map<std::string, std::uint64_t> counted;  // by file: how many names it has given
  for (std::size_t i = 0; i < models.size(); ++i) {
    const auto field = find(models[i], "name");
    if (!field) continue;
    planned[i].name = text(*field);
    if (taken.insert(planned[i].name).second) continue;
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

/// Without an id of its own, a model gets its position in the list, counted from 1.
void read_ids(const std::vector<YamlField>& models, std::vector<PlannedInstance>& planned) {
  std::map<std::uint32_t, std::size_t> taken;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const auto field = find(models[i], "id");
    planned[i].id =
        field ? whole_number(*field, 0, kInvalidId - 1) : static_cast<std::uint32_t>(i + 1);
    const auto [other, is_new] = taken.try_emplace(planned[i].id, i);
    if (is_new) continue;
    reject(field ? *field : models[i],
           "id " + std::to_string(planned[i].id) + ", which models[" +
               std::to_string(other->second) + "] has",
           "each id once (without 'id' it is the place in the list, from 1)",
           "give one of them another id");
  }
}

std::vector<PlannedInstance> read_models(const YamlField& field, const ModelOptions& defaults,
                                         std::vector<std::string>& files) {
  const std::vector<YamlField> models = items(field);
  if (models.empty()) reject(field, "an empty list", "at least one model");
  std::vector<PlannedInstance> planned;
  for (const YamlField& model : models) planned.push_back(read_model(model, defaults, files));
  read_names(models, planned);
  read_ids(models, planned);
  return planned;
}

}  // namespace

std::vector<MaterialOverride> read_overrides(const YamlField& field) {
  std::vector<MaterialOverride> changes;
  for (const auto& [material, value] : entries(field)) {
    changes.push_back(read_override(material, value));
  }
  // Changes of one material have priority over changes of all, in any order.
  std::stable_partition(changes.begin(), changes.end(),
                        [](const MaterialOverride& change) { return change.material == "*"; });
  return changes;
}

ScenePlan read_scene_plan(const fs::path& path, const ModelOptions& defaults) {
  ScenePlan plan = read_scene_plan(read_yaml(path), defaults);
  plan.files.insert(plan.files.begin(), path.string());
  return plan;
}

ScenePlan read_scene_plan(const YamlField& root, const ModelOptions& defaults) {
  require_map(root, {"models", "sensor", "sensor_pose", "sensor_motion", "sensors", "rig_pose",
                     "rig_motion"});
  ScenePlan plan;
  plan.instances = read_models(need(root, "models"), defaults, plan.files);
  for (const PlannedInstance& planned : plan.instances) {
    for (const MaterialOverride& change : planned.overrides) {
      if (!change.noise_texture.empty()) plan.files.push_back(change.noise_texture);
    }
  }
  read_rig(root, plan);
  return plan;
}

}  // namespace glidar
