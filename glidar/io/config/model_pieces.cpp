// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/model_pieces.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/mesh.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/model/model_parts.hpp>

#include <algorithm>
#include <numeric>
#include <string_view>
#include <tuple>
#include <utility>

namespace glidar {
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
    for (const std::uint32_t index : model.whole.materials) {
      materials_.push_back(scene.materials[index].name);
    }
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
    for (std::size_t i = 0; i < known.size() && i < kListed; ++i) {
      listed += (i == 0 ? "'" : ", '") + known[i] + "'";
    }
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

}  // namespace glidar
