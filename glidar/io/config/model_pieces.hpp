// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: how parts of a model become instances.

#include <glidar/io/config/scene_plan.hpp>

#include <map>
#include <string>
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

}  // namespace glidar
