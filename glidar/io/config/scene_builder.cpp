// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/scene_plan.hpp>

#include <glidar/core/box_classes.hpp>
#include <glidar/core/error.hpp>
#include <glidar/core/hits.hpp>
#include <glidar/core/mesh.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>
#include <glidar/io/model/model_parts.hpp>
#include <glidar/io/model/png_texture.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

namespace glidar {

/// The triangles of one node with one material: no override concerns only some of them.
struct ModelAtom {
  std::uint32_t node = 0;
  std::uint16_t slot = 0;
  std::vector<std::uint32_t> triangles;  ///< ascending
};

/// The mesh of a piece, with the materials that its triangles have.
struct PieceMesh {
  std::uint32_t index = 0;           ///< into Scene::meshes
  std::vector<std::uint16_t> slots;  ///< of the model, per slot of this mesh
};

/// A model in a scene, and what it was cut into.
struct LoadedModel {
  Instance whole;  ///< as the model came, before the changes of a scene file
  std::vector<ModelPart> parts;
  std::vector<ModelNode> nodes;
  std::vector<std::string> names;  ///< part_names() of the nodes
  std::vector<ModelAtom> atoms;    ///< by node and slot; empty until the model is cut
  std::map<std::vector<std::uint32_t>, PieceMesh> meshes;  ///< of pieces, by their atoms
};

/// Atoms of a model that become one instance.
struct ModelPiece {
  std::vector<std::uint32_t> atoms = {};            ///< ascending
  std::vector<const PartOverride*> overrides = {};  ///< in the order of the file
  std::string name;                                 ///< after that of the instance; empty: the rest
  std::string class_name;                           ///< by `split`; empty: that of the model
  Pose model_from_piece = Pose::Identity();         ///< by poses of parts
};

/// The pieces of a planned instance, in the order of their first triangles. Throws Error at a
/// selector without parts, and at a pose for several of them.
std::vector<ModelPiece> cut_model(const PlannedInstance& planned, const Scene& scene,
                                  LoadedModel& model);

/// The mesh of a piece, which the scene gets once.
const PieceMesh& mesh_of_piece(const ModelPiece& piece, LoadedModel& model, Scene& scene);

namespace {

constexpr std::string_view kMaterialPrefix = "material:";

std::vector<ModelAtom> atoms_of(const Mesh& mesh, const std::vector<ModelPart>& parts) {
  std::vector<std::uint32_t> nodes(mesh.triangles.size(), 0);
  for (const ModelPart& part : parts) {
    std::fill_n(nodes.begin() + part.first_triangle, part.triangle_count, part.node);
  }
  std::map<std::pair<std::uint32_t, std::uint16_t>, std::uint32_t> places;
  std::vector<ModelAtom> atoms;
  for (std::uint32_t t = 0; t < nodes.size(); ++t) {
    const std::uint16_t slot = material_slot(mesh, t);
    const auto [place, is_new] =
        places.try_emplace({nodes[t], slot}, static_cast<std::uint32_t>(atoms.size()));
    if (is_new) atoms.push_back({nodes[t], slot, {}});
    atoms[place->second].triangles.push_back(t);
  }
  return atoms;
}

/// What the selectors of one planned instance choose.
class Selection {
 public:
  Selection(const LoadedModel& model, const Scene& scene) : model_(model) {
    for (const std::uint32_t index : model.whole.materials)
      materials_.push_back(scene.materials[index].name);
  }

  /// The name of the material of a slot.
  [[nodiscard]] const std::string& material(std::uint16_t slot) const { return materials_[slot]; }

  /// Per atom: whether the selector chooses it, a part above it, or its material.
  [[nodiscard]] std::vector<bool> atoms(const std::string& selector) const {
    std::vector<bool> chosen;
    const bool is_material = selector.starts_with(kMaterialPrefix);
    const std::vector<bool> nodes = is_material ? std::vector<bool>{} : with_children(selector);
    const std::string_view pattern =
        std::string_view(selector).substr(is_material ? kMaterialPrefix.size() : 0);
    for (const ModelAtom& atom : model_.atoms) {
      chosen.push_back(is_material ? matches_pattern(pattern, material(atom.slot))
                                   : nodes[atom.node]);
    }
    return chosen;
  }

  /// The only part with a pose of its own.
  [[nodiscard]] std::uint32_t node(const PartOverride& part) const {
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 1; i < model_.names.size(); ++i) {
      if (matches_pattern(part.selector, model_.names[i])) found.push_back(i);
    }
    if (found.size() == 1) return found.front();
    throw Error({part.where + ".pose", "a pose for " + std::to_string(found.size()) + " parts",
                 "a pose of one part", "name the part"});
  }

  [[noreturn]] void reject_unknown(const PartOverride& part) const {
    constexpr std::size_t kListed = 8;
    std::vector<std::string> known(model_.names.begin() + 1, model_.names.end());
    for (const std::string& name : materials_) {
      const std::string selector = std::string(kMaterialPrefix) + name;
      if (std::find(known.begin(), known.end(), selector) == known.end()) known.push_back(selector);
    }
    std::string listed;
    for (std::size_t i = 0; i < known.size() && i < kListed; ++i)
      listed += (i == 0 ? "'" : ", '") + known[i] + "'";
    if (known.size() > kListed) listed += " ... ('glidar info --parts' lists all)";
    const std::string nearest = closest_match(part.selector, known);
    throw Error({part.where, "the model has no part '" + excerpt(part.selector) + "'", listed,
                 nearest.empty() ? "" : "did you mean '" + nearest + "'?"});
  }

 private:
  [[nodiscard]] std::vector<bool> with_children(const std::string& selector) const {
    std::vector<bool> chosen;
    for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
      chosen.push_back(matches_pattern(selector, model_.names[i]) ||
                       (i > 0 && chosen[model_.nodes[i].parent]));
    }
    return chosen;
  }

  const LoadedModel& model_;
  std::vector<std::string> materials_;  ///< per slot
};

/// How parts with poses move their triangles.
struct Displacements {
  std::vector<Pose> model_from_rest;      ///< per node: from where the file has it
  std::vector<std::uint32_t> moved_with;  ///< per node: the nearest with a pose of its own; 0: none
};

Displacements displacements_of(const LoadedModel& model,
                               const std::map<std::uint32_t, Pose>& parent_from_part) {
  Displacements all;
  for (std::uint32_t i = 0; i < model.nodes.size(); ++i) {
    const ModelNode& node = model.nodes[i];
    Pose moved = i == 0 ? Pose::Identity() : all.model_from_rest[node.parent];
    const auto given = parent_from_part.find(i);
    const bool is_given = given != parent_from_part.end();
    if (is_given) {
      const Pose& model_from_parent = model.nodes[node.parent].model_from_node;
      moved = moved * model_from_parent * given->second * node.model_from_node.inverse();
    }
    all.moved_with.push_back(is_given ? i : (i == 0 ? 0 : all.moved_with[node.parent]));
    all.model_from_rest.push_back(moved);
  }
  return all;
}

/// The part or material by which `split` makes an object of the atom; empty: it has no name.
std::string split_name(const ModelAtom& atom, Split split, const LoadedModel& model,
                       const Selection& selection) {
  if (split == Split::none) return "";
  return split == Split::parts ? model.names[atom.node] : selection.material(atom.slot);
}

/// A piece without atoms yet, with its name and class.
ModelPiece named_piece(const PlannedInstance& planned, const std::string& split_name,
                       std::vector<const PartOverride*> overrides) {
  ModelPiece piece;
  if (planned.split == Split::none) {
    if (!overrides.empty()) piece.name = overrides.back()->selector;
  } else if (split_name.empty()) {
    piece.name = planned.name;
    piece.class_name = planned.class_name.empty() ? planned.name : planned.class_name;
  } else {
    piece.name = split_name;
    piece.class_name = split_name;
  }
  piece.overrides = std::move(overrides);
  return piece;
}

/// Leaves out the material slots that no triangle has. Returns the former numbers of the others.
std::vector<std::uint16_t> compact_slots(Mesh& mesh) {
  std::vector<std::uint16_t> slots = mesh.material_slots;
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  for (std::uint16_t& slot : mesh.material_slots) {
    slot = static_cast<std::uint16_t>(std::lower_bound(slots.begin(), slots.end(), slot) -
                                      slots.begin());
  }
  if (slots.empty()) slots.push_back(0);
  return slots;
}

}  // namespace

std::vector<ModelPiece> cut_model(const PlannedInstance& planned, const Scene& scene,
                                  LoadedModel& model) {
  if (model.atoms.empty()) model.atoms = atoms_of(scene.meshes[model.whole.mesh], model.parts);
  const Selection selection(model, scene);
  std::vector<std::vector<bool>> chosen;
  std::map<std::uint32_t, Pose> poses;
  for (const PartOverride& part : planned.parts) {
    chosen.push_back(selection.atoms(part.selector));
    const bool is_known =
        std::find(chosen.back().begin(), chosen.back().end(), true) != chosen.back().end();
    if (!is_known) selection.reject_unknown(part);
    if (part.parent_from_part) poses[selection.node(part)] = *part.parent_from_part;
  }
  const Displacements moved = displacements_of(model, poses);
  using Key = std::tuple<std::vector<const PartOverride*>, std::uint32_t, std::string>;
  std::map<Key, std::size_t> places;
  std::vector<ModelPiece> pieces;
  for (std::uint32_t a = 0; a < model.atoms.size(); ++a) {
    const ModelAtom& atom = model.atoms[a];
    std::vector<const PartOverride*> overrides;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      if (chosen[k][a]) overrides.push_back(&planned.parts[k]);
    }
    const std::string name = split_name(atom, planned.split, model, selection);
    const auto [place, is_new] =
        places.try_emplace({overrides, moved.moved_with[atom.node], name}, pieces.size());
    if (is_new) {
      pieces.push_back(named_piece(planned, name, std::move(overrides)));
      pieces.back().model_from_piece = moved.model_from_rest[atom.node];
    }
    pieces[place->second].atoms.push_back(a);
  }
  return pieces;
}

const PieceMesh& mesh_of_piece(const ModelPiece& piece, LoadedModel& model, Scene& scene) {
  const auto [place, is_new] = model.meshes.try_emplace(piece.atoms);
  PieceMesh& mesh = place->second;
  if (!is_new) return mesh;
  if (piece.atoms.size() == model.atoms.size()) {
    mesh.index = model.whole.mesh;
    mesh.slots.resize(model.whole.materials.size());
    std::iota(mesh.slots.begin(), mesh.slots.end(), std::uint16_t{0});
    return mesh;
  }
  mesh.index = static_cast<std::uint32_t>(scene.meshes.size());
  std::vector<std::uint32_t> triangles;
  for (const std::uint32_t a : piece.atoms) {
    const std::vector<std::uint32_t>& more = model.atoms[a].triangles;
    triangles.insert(triangles.end(), more.begin(), more.end());
  }
  std::sort(triangles.begin(), triangles.end());
  scene.meshes.push_back(extract_triangles(scene.meshes[model.whole.mesh], triangles));
  scene.sources.push_back(MeshSource(scene.sources[model.whole.mesh]));
  mesh.slots = compact_slots(scene.meshes.back());
  return mesh;
}

namespace {

/// Name of a sensor that is not part of a rig.
constexpr const char* kOnlySensor = "sensor";

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

/// Throws Error if the change concerns none of the materials of its owner, "the model" or a part.
void require_known(const MaterialOverride& change, const std::vector<std::uint32_t>& materials,
                   const Scene& scene, const std::string& owner) {
  std::vector<std::string> names;
  std::string listed;
  for (const std::uint32_t index : materials) {
    if (concerns(change, scene.materials[index])) return;
    const std::string& name = scene.materials[index].name;
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    names.push_back(name);
    listed += (listed.empty() ? "'" : ", '") + name + "'";
  }
  const std::string nearest = closest_match(change.material, names);
  throw Error({change.where, owner + " has no material '" + excerpt(change.material) + "'",
               listed + ", or '*' for all",
               nearest.empty() ? "" : "did you mean '" + nearest + "'?"});
}

/// Gives the instance copies of the materials that change: others may share the originals. It need
/// not have the materials of all changes.
void override_materials(const std::vector<MaterialOverride>& overrides, TexturePlaces& places,
                        Instance& instance, Scene& scene) {
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

/// The same for a whole model, which has the materials of all changes.
void override_known_materials(const std::vector<MaterialOverride>& overrides, TexturePlaces& places,
                              Instance& instance, Scene& scene) {
  for (const MaterialOverride& change : overrides)
    require_known(change, instance.materials, scene, "the model");
  override_materials(overrides, places, instance, scene);
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
  for (const std::string& name : names)
    places.try_emplace(name, static_cast<std::uint32_t>(places.size()));
  return places;
}

[[noreturn]] void reject_sensor(const std::string& name, const std::vector<std::string>& known,
                                const std::string& where) {
  std::string listed;
  for (const std::string& one : known) listed += (listed.empty() ? "'" : ", '") + one + "'";
  const std::string nearest = closest_match(name, known);
  const std::string remedy = nearest.empty() ? "" : "did you mean '" + nearest + "'?";
  const bool is_rig = known.size() > 1 || known.front() != kOnlySensor;
  throw Error(
      {where,
       (is_rig ? "the rig has no sensor '" : "the scene has no sensor '") + excerpt(name) + "'",
       listed + (is_rig ? "" : ", its only one"),
       is_rig || !remedy.empty() ? remedy : "list several in 'sensors', with names"});
}

/// The names of sensors by their ids.
std::vector<std::string> sensor_names(const std::vector<RigSensor>& rig) {
  std::vector<std::string> names;
  for (const RigSensor& sensor : rig) names.push_back(sensor.name);
  const bool has_no_names = rig.empty() || (rig.size() == 1 && names[0].empty());
  return has_no_names ? std::vector<std::string>{kOnlySensor} : names;
}

std::vector<std::uint32_t> ids_of(const SensorNames& sensors, const std::vector<RigSensor>& rig) {
  const std::vector<std::string> known = sensor_names(rig);
  std::vector<std::uint32_t> ids;
  for (const std::string& name : sensors.names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) reject_sensor(name, known, sensors.where);
    ids.push_back(static_cast<std::uint32_t>(found - known.begin()));
  }
  return ids;
}

void set_visibility(const Visibility& visibility, const std::vector<RigSensor>& rig,
                    Instance& instance) {
  if (!visibility.visible_to.names.empty()) {
    instance.visible_to = ids_of(visibility.visible_to, rig);
  }
  if (!visibility.hidden_from.names.empty()) {
    instance.hidden_from = ids_of(visibility.hidden_from, rig);
  }
}

/// The planned instance's own frame, in which a piece is moved by poses of parts. A scale with
/// factors of equal size, also negative ones, keeps that rigid.
Pose object_from_piece(const PlannedInstance& planned, const ModelPiece& piece) {
  const Pose& moved = piece.model_from_piece;
  if (moved.matrix() == Eigen::Matrix4d::Identity()) return moved;
  const Eigen::Vector3d& scale = planned.scale;
  if ((scale.cwiseAbs().array() != std::abs(scale.x())).any()) {
    throw Error({planned.where, "different scale factors for a model with poses of parts",
                 "factors of equal size", "scale the model in its file"});
  }
  const Eigen::Vector3d sign = scale.cwiseSign();
  Pose result = Pose::Identity();
  result.linear() = sign.asDiagonal() * moved.linear() * sign.asDiagonal();
  result.translation() = scale.cwiseProduct(moved.translation());
  return result;
}

/// Removes meshes that were cut, if no instance has them. The others keep their order.
void drop_cut_meshes(const std::vector<std::uint32_t>& cut, Scene& scene) {
  std::vector<bool> is_dropped(scene.meshes.size(), false);
  for (const std::uint32_t mesh : cut) is_dropped[mesh] = true;
  for (const Instance& instance : scene.instances) {
    is_dropped[instance.mesh] = false;
    const MeshSource& source = scene.sources[instance.mesh];
    if (source.stretch != Eigen::Vector3d::Ones()) is_dropped[source.unstretched] = false;
  }
  std::vector<std::uint32_t> renumbered;
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < scene.meshes.size(); ++i) {
    renumbered.push_back(kept);
    if (is_dropped[i]) continue;
    if (kept != i) {
      scene.meshes[kept] = std::move(scene.meshes[i]);
      scene.sources[kept] = std::move(scene.sources[i]);
    }
    ++kept;
  }
  scene.meshes.resize(kept);
  scene.sources.resize(kept);
  for (Instance& instance : scene.instances) instance.mesh = renumbered[instance.mesh];
  for (MeshSource& source : scene.sources) source.unstretched = renumbered[source.unstretched];
}

/// The last entry that selects a piece gives it its id.
bool has_id_of(const ModelPiece& piece, const PartOverride& part) {
  return !piece.overrides.empty() && piece.overrides.back() == &part;
}

std::optional<std::uint32_t> given_id(const ModelPiece& piece) {
  return piece.overrides.empty() ? std::nullopt : piece.overrides.back()->id;
}

/// Throws Error unless each given id is that of one object.
void require_used_ids(const PlannedInstance& planned, const std::vector<ModelPiece>& pieces) {
  for (const PartOverride& part : planned.parts) {
    if (!part.id) continue;
    const auto objects =
        std::count_if(pieces.begin(), pieces.end(),
                      [&part](const ModelPiece& piece) { return has_id_of(piece, part); });
    if (objects == 1) continue;
    if (objects == 0) {
      throw Error({part.where + ".id", "later entries select all of it", "an id of an object",
                   "give it to the last of these entries"});
    }
    throw Error({part.where + ".id", "an id for " + std::to_string(objects) + " objects",
                 "an id of one object", "give the others entries after this one"});
  }
}

/// The materials of the triangles that an entry selects, as the model came.
std::vector<std::uint32_t> materials_of(const PartOverride& part,
                                        const std::vector<ModelPiece>& pieces,
                                        const LoadedModel& model) {
  std::set<std::uint32_t> materials;
  for (const ModelPiece& piece : pieces) {
    const auto& entries = piece.overrides;
    if (std::find(entries.begin(), entries.end(), &part) == entries.end()) continue;
    for (const std::uint32_t a : piece.atoms) {
      materials.insert(model.whole.materials[model.atoms[a].slot]);
    }
  }
  return {materials.begin(), materials.end()};
}

/// Throws Error if an entry changes a material that its triangles do not have.
void require_known_materials(const PlannedInstance& planned, const std::vector<ModelPiece>& pieces,
                             const LoadedModel& model, const Scene& scene) {
  for (const PartOverride& part : planned.parts) {
    if (part.materials.empty()) continue;
    const std::vector<std::uint32_t> materials = materials_of(part, pieces, model);
    for (const MaterialOverride& change : part.materials) {
      require_known(change, materials, scene, "the part '" + excerpt(part.selector) + "'");
    }
  }
}

/// Places the models of a plan.
class SceneBuilder {
 public:
  SceneBuilder(const ScenePlan& plan, const ModelLoader& load, SceneFile& file)
      : plan_(plan),
        load_(load),
        scene_(file.scene),
        trajectories_(file.world_from_instance),
        classes_(places_of(file.scene.class_names)) {
    for (const Instance& instance : scene_.instances) {
      names_.insert(instance.name);
      ids_.insert(instance.id);
    }
    for (const PlannedInstance& planned : plan.instances) take_name_and_id(planned);
    for (const PlannedInstance& planned : plan.instances) check_parts(planned);
    for (const Instance& instance : scene_.instances)
      trajectories_.emplace_back(ConstantPose{instance.world_from_object});
  }

  void build() {
    for (const PlannedInstance& planned : plan_.instances) {
      if (planned.parts.empty() && planned.split == Split::none) {
        place_whole(planned);
      } else {
        place_pieces(planned);
      }
    }
    if (!cut_meshes_.empty()) drop_cut_meshes(cut_meshes_, scene_);
    const auto moves = [](const PlannedInstance& planned) { return planned.motion.has_value(); };
    if (std::none_of(plan_.instances.begin(), plan_.instances.end(), moves)) trajectories_.clear();
    validate(scene_);
  }

 private:
  void take_name_and_id(const PlannedInstance& planned) {
    if (!names_.insert(planned.name).second) {
      throw Error({planned.where,
                   "the name '" + excerpt(planned.name) + "', which another object has",
                   "a name that is unique in the scene", "choose another name"});
    }
    if (!ids_.insert(planned.id).second) {
      throw Error({planned.where, "id " + std::to_string(planned.id) + ", which another object has",
                   "an id that is unique in the scene", "give it another id"});
    }
  }

  /// Finds what is wrong with sensors and entries of `parts` before a model is loaded.
  void check_parts(const PlannedInstance& planned) {
    Instance any;
    set_visibility(planned.visibility, plan_.sensors, any);
    for (const PartOverride& part : planned.parts) {
      if (part.selector.empty()) {
        throw Error({part.where, "an empty name", "names and patterns of parts, 'material:NAME'",
                     "'*' selects the whole model"});
      }
      set_visibility(part.visibility, plan_.sensors, any);
      if (!part.id || ids_.insert(*part.id).second) continue;
      throw Error({part.where + ".id", "id " + std::to_string(*part.id) + ", which another has",
                   "each id once", "give one of them another id"});
    }
  }

  LoadedModel& loaded(const PlannedInstance& planned) {
    const LoadKey key = load_key(planned, real_paths_);
    const auto [place, is_new] = loaded_.try_emplace(key);
    LoadedModel& model = place->second;
    if (!is_new) return model;
    Model read = load_for(planned, load_);
    model.parts = std::move(read.parts);
    model.nodes = std::move(read.nodes);
    model.names = part_names(model.nodes);
    const std::size_t first = add_model(scene_, std::move(read));
    model.whole = std::move(scene_.instances[first]);
    scene_.instances.pop_back();
    return model;
  }

  /// An instance with what the plan gives the whole model.
  Instance instance_of(const PlannedInstance& planned, const LoadedModel& model) {
    Instance instance = model.whole;
    instance.name = planned.name;
    instance.world_from_object = planned.world_from_object;
    instance.id = planned.id;
    instance.class_id = class_index(planned.class_name, classes_, scene_.class_names);
    set_visibility(planned.visibility, plan_.sensors, instance);
    override_known_materials(planned.overrides, textures_, instance, scene_);
    return instance;
  }

  void add(const PlannedInstance& planned, Instance instance, const Pose& object_from_piece) {
    const bool is_moved = object_from_piece.matrix() != Eigen::Matrix4d::Identity();
    if (is_moved) instance.world_from_object = planned.world_from_object * object_from_piece;
    Trajectory motion = planned.motion.value_or(ConstantPose{planned.world_from_object});
    if (is_moved) motion = compose_extrinsic(motion, object_from_piece);
    scene_.instances.push_back(std::move(instance));
    trajectories_.push_back(std::move(motion));
    try {
      set_scale(scene_, scene_.instances.size() - 1, planned.scale);
    } catch (const Error& error) {
      reject_at(planned.where, error);
    }
  }

  void place_whole(const PlannedInstance& planned) {
    const Instance instance = instance_of(planned, loaded(planned));
    if (planned.poses.empty()) return add(planned, instance, Pose::Identity());
    const std::size_t count = planned.poses.size();
    const std::uint32_t first = first_free_id(planned, count, true);
    for (std::size_t i = 0; i < count; ++i) {
      Instance one = instance;
      if (i > 0) one.name = free_name(planned.name);
      one.id = first + static_cast<std::uint32_t>(i);
      ids_.insert(one.id);
      add(planned, std::move(one), planned.poses[i]);
    }
  }

  void place_pieces(const PlannedInstance& planned) {
    LoadedModel& model = loaded(planned);
    Instance common = instance_of(planned, model);
    const std::vector<std::uint32_t> materials = std::exchange(common.materials, {});
    const std::vector<ModelPiece> pieces = cut_model(planned, scene_, model);
    require_known_materials(planned, pieces, model, scene_);
    const std::vector<std::uint32_t> ids = ids_of_pieces(planned, pieces);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const ModelPiece& piece = pieces[i];
      const PieceMesh& mesh = mesh_of_piece(piece, model, scene_);
      Instance instance = common;
      instance.id = ids[i];
      instance.mesh = mesh.index;
      for (const std::uint16_t slot : mesh.slots) instance.materials.push_back(materials[slot]);
      if (!piece.name.empty()) instance.name = free_name(planned.name + "/" + piece.name);
      if (!piece.class_name.empty()) {
        instance.class_id = class_index(piece.class_name, classes_, scene_.class_names);
      }
      for (const PartOverride* part : piece.overrides) apply_override(*part, instance);
      add(planned, std::move(instance), object_from_piece(planned, piece));
    }
    if (pieces.size() > 1) cut_meshes_.push_back(model.whole.mesh);
  }

  void apply_override(const PartOverride& part, Instance& instance) {
    if (!part.class_name.empty()) {
      instance.class_id = class_index(part.class_name, classes_, scene_.class_names);
    }
    set_visibility(part.visibility, plan_.sensors, instance);
    override_materials(part.materials, textures_, instance, scene_);
  }

  std::string free_name(const std::string& base) {
    std::uint64_t& n = last_numbers_[base];
    std::string name;
    do name = ++n == 1 ? base : base + "_" + std::to_string(n);
    while (!names_.insert(name).second);
    return name;
  }

  /// The first of consecutive free ids: that of the model if the others after it are free, else
  /// above all.
  std::uint32_t first_free_id(const PlannedInstance& planned, std::size_t count, bool after_model) {
    const auto next = ids_.upper_bound(planned.id);
    const bool is_free = after_model && (next == ids_.end() || *next - planned.id >= count);
    const std::uint64_t first = is_free ? planned.id : std::uint64_t{*ids_.rbegin()} + 1;
    if (first + count > kInvalidId) {
      throw Error({planned.where, "no ids are left for its parts", "ids up to 4294967294",
                   "give models smaller ids"});
    }
    return static_cast<std::uint32_t>(first);
  }

  /// Ids of objects are unique.
  std::vector<std::uint32_t> ids_of_pieces(const PlannedInstance& planned,
                                           const std::vector<ModelPiece>& pieces) {
    require_used_ids(planned, pieces);
    const auto needs_id = [](const ModelPiece& piece) {
      return !piece.name.empty() && !given_id(piece);
    };
    const auto count =
        static_cast<std::size_t>(std::count_if(pieces.begin(), pieces.end(), needs_id));
    const bool is_split = planned.split != Split::none;
    std::uint32_t next = count == 0 ? planned.id : first_free_id(planned, count, is_split);
    std::vector<std::uint32_t> ids;
    for (const ModelPiece& piece : pieces) {
      ids.push_back(needs_id(piece) ? next++ : given_id(piece).value_or(planned.id));
      ids_.insert(ids.back());
    }
    return ids;
  }

  const ScenePlan& plan_;
  const ModelLoader& load_;
  Scene& scene_;
  std::vector<Trajectory>& trajectories_;
  ClassPlaces classes_;
  TexturePlaces textures_;
  std::map<LoadKey, LoadedModel> loaded_;
  RealPaths real_paths_;
  std::set<std::string> names_;
  std::unordered_map<std::string, std::uint64_t> last_numbers_;
  std::set<std::uint32_t> ids_;
  std::vector<std::uint32_t> cut_meshes_;
};

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
    override_known_materials(overrides, places, changed, scene);
  } catch (...) {
    scene.materials.resize(materials);
    scene.textures.resize(textures);
    throw;
  }
  scene.instances[instance] = std::move(changed);
}

SceneFile build_scene(const ScenePlan& plan, const ModelLoader& load, Scene into) {
  SceneFile file{.scene = std::move(into),
                 .sensors = plan.sensors,
                 .world_from_rig = plan.world_from_rig,
                 .looks_at = plan.looks_at,
                 .files = plan.files,
                 .rig_motion = plan.rig_motion,
                 .imus = plan.imus,
                 .gravity_m_s2 = plan.gravity_m_s2};
  SceneBuilder(plan, load, file).build();
  boxed_classes(file.scene.class_names, plan.box_classes, plan.where_box_classes);  // its errors
  file.box_classes = plan.box_classes;
  return file;
}

}  // namespace glidar
