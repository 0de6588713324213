// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/scene_builder.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/excerpt.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>
#include <glidar/io/model/png_texture.hpp>

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

namespace glidar {
namespace {

/// Instances that agree in these share one mesh.
using LoadKey = std::pair<std::string, ModelOptions>;

/// The same text for every spelling of a file's path.
std::string canonical_name(const std::string& path) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(path, error);
  return error ? path : real.string();
}

/// Canonical paths, requested from the system once for all instances of a model.
using RealPaths = std::unordered_map<std::string, std::string>;

LoadKey load_key(const PlannedInstance& planned, RealPaths& known) {
  const auto [real, is_new] = known.try_emplace(planned.source);
  if (is_new) real->second = canonical_name(planned.source);
  return {real->second, planned.options};
}

/// Where in Scene::textures the files lie that this scene names.
using TexturePlaces = std::map<std::string, std::int32_t>;

Model load_for(const PlannedInstance& planned, const ModelLoader& load) {
  try {
    return load(planned.source, planned.options);
  } catch (const Error& error) {
    reject_at(planned.where, error);
  }
}

/// The texture of a file, loaded when it is named for the first time.
std::int32_t place_of(const MaterialOverride& change, TexturePlaces& places, Scene& scene) {
  const auto next = static_cast<std::int32_t>(scene.textures.size());
  const auto [place, is_new] = places.try_emplace(canonical_name(change.noise_texture), next);
  if (!is_new) return place->second;
  try {
    scene.textures.push_back(read_png_texture(change.noise_texture));
  } catch (const Error& error) {
    reject_at(change.where_noise_texture, error);
  }
  return next;
}

void apply(const MaterialOverride& change, TexturePlaces& places, Scene& scene,
           Material& material) {
  material.noise_scale = change.noise_scale.value_or(material.noise_scale);
  material.ambient = change.ambient.value_or(material.ambient);
  material.diffuse = change.diffuse.value_or(material.diffuse);
  material.specular = change.specular.value_or(material.specular);
  material.shininess = change.shininess.value_or(material.shininess);
  material.backscatter = change.backscatter.value_or(material.backscatter);
  material.mirror = change.mirror.value_or(material.mirror);
  if (!change.spectrum.empty()) material.spectrum = change.spectrum;
  if (!change.noise_texture.empty()) {
    material.noise_texture = {.texture = place_of(change, places, scene)};
  }
  if (change.opacity) {
    constexpr float kCutoff = 0.5F;  // a beam passes or it does not: nothing is half there
    material.opacity = *change.opacity;
    material.alpha_cutoff = std::max(material.alpha_cutoff, kCutoff);
  }
}

bool concerns(const MaterialOverride& change, const Material& material) {
  return change.material == "*" || change.material == material.name;
}

void require_known(const MaterialOverride& change, const Instance& instance, const Scene& scene) {
  std::vector<std::string> names;
  std::string listed;
  for (const std::uint32_t index : instance.materials) {
    if (concerns(change, scene.materials[index])) return;
    const std::string& name = scene.materials[index].name;
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    names.push_back(name);
    listed += (listed.empty() ? "'" : ", '") + name + "'";
  }
  const std::string nearest = closest_match(change.material, names);
  throw Error({change.where, "the model has no material '" + excerpt(change.material) + "'",
               listed + ", or '*' for all",
               nearest.empty() ? "" : "did you mean '" + nearest + "'?"});
}

/// Gives the instance copies of the materials that change: others may share the originals.
void override_materials(const std::vector<MaterialOverride>& overrides, TexturePlaces& places,
                        Instance& instance, Scene& scene) {
  for (const MaterialOverride& change : overrides) {
    require_known(change, instance, scene);
  }
  for (std::uint32_t& index : instance.materials) {
    Material changed = scene.materials[index];
    bool is_changed = false;
    for (const MaterialOverride& change : overrides) {
      if (!concerns(change, changed)) continue;
      apply(change, places, scene, changed);
      is_changed = true;
    }
    if (!is_changed) continue;
    index = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(std::move(changed));
  }
}

/// Where in Scene::class_names the names are.
using ClassPlaces = std::unordered_map<std::string, std::uint32_t>;

std::uint32_t class_index(const std::string& name, ClassPlaces& places,
                          std::vector<std::string>& names) {
  if (name.empty()) return 0;
  const auto next = static_cast<std::uint32_t>(names.size());
  const auto [place, is_new] = places.try_emplace(name, next);
  if (is_new) names.push_back(name);
  return place->second;
}

ClassPlaces places_of(const std::vector<std::string>& names) {
  ClassPlaces places;
  for (const std::string& name : names) {
    places.try_emplace(name, static_cast<std::uint32_t>(places.size()));
  }
  return places;
}

std::vector<MaterialOverride> read_overrides(const YamlField& root) {
  std::vector<MaterialOverride> changes;
  for (const auto& [material, field] : entries(root)) {
    changes.emplace_back().material = material;
    read_struct(field, changes.back());
  }
  sort_overrides(changes);
  return changes;
}

}  // namespace

void set_materials(Scene& scene, std::size_t instance, const std::string& text,
                   const std::filesystem::path& folder) {
  TexturePlaces places;
  Instance changed = scene.instances.at(instance);
  const auto overrides = read_overrides(read_yaml_text((folder / "materials").string(), text));
  const std::size_t materials = scene.materials.size();
  const std::size_t textures = scene.textures.size();
  try {
    override_materials(overrides, places, changed, scene);
  } catch (...) {
    scene.materials.resize(materials);
    scene.textures.resize(textures);
    throw;
  }
  scene.instances[instance] = std::move(changed);
}

Scene build_scene(const ScenePlan& plan, const ModelLoader& load) {
  Scene scene;
  TexturePlaces places;
  std::map<LoadKey, Instance> loaded;  // as the model came, before this file's changes
  RealPaths real_paths;
  ClassPlaces classes = places_of(scene.class_names);
  for (const PlannedInstance& planned : plan.instances) {
    const LoadKey key = load_key(planned, real_paths);
    if (!loaded.contains(key)) {
      const std::size_t first = add_model(scene, load_for(planned, load));
      loaded[key] = scene.instances[first];
      scene.instances.pop_back();
    }
    Instance instance = loaded.at(key);
    instance.name = planned.name;
    instance.world_from_object = planned.world_from_object;
    instance.id = planned.id;
    instance.class_id = class_index(planned.class_name, classes, scene.class_names);
    override_materials(planned.overrides, places, instance, scene);
    scene.instances.push_back(std::move(instance));
    try {
      set_scale(scene, scene.instances.size() - 1, planned.scale);
    } catch (const Error& error) {
      reject_at(planned.where, error);
    }
  }
  validate(scene);
  return scene;
}

}  // namespace glidar
