// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

struct aiMesh;
struct aiNode;
struct aiScene;

namespace glidar::import {

/// Thrown if a file cannot become a model; the texts become part of the user's error.
struct Refusal {
  std::string found;
  std::string remedy;
};

/// The error for a file without surfaces; `instead`: its content, "" or ", only ...".
Refusal no_triangles(const std::string& instead);

/// An instance of a mesh of the file in its tree.
struct Placed {
  const aiMesh* mesh = nullptr;
  Eigen::Matrix4d model_from_mesh = Eigen::Matrix4d::Identity();
  std::string name;
};

struct Walk {
  std::vector<Placed> placed;  ///< meshes with triangles; nodes depth first, parents first
  std::uint64_t triangles = 0;
  std::uint64_t lines_and_points = 0;  ///< left out
  std::uint64_t skinned = 0;           ///< meshes with a skeleton
};

/// parent_from_node of nodes with transforms in more than the importer's single precision.
using NodeTransforms = std::unordered_map<const aiNode*, Eigen::Matrix4d>;

/// Walks the file's tree. Throws Refusal if it has no triangles, or too many.
Walk walk(const aiScene& scene, const NodeTransforms& transforms);

}  // namespace glidar::import
