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

/// Raised when a file cannot become a model; the texts go into the user's error.
struct Refusal {
  std::string found;
  std::string remedy;
};

/// The file has no surface; `instead`: what it has, "" or ", only ...".
Refusal no_triangles(const std::string& instead);

/// One mesh of the file at one place in its tree.
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

/// parent_from_node of nodes whose transform is known better than the importer's single precision.
using NodeTransforms = std::unordered_map<const aiNode*, Eigen::Matrix4d>;

/// Walks the file's tree. Throws Refusal when it holds no triangles, or more than can be had.
Walk walk(const aiScene& scene, const NodeTransforms& transforms);

}  // namespace glidar::import
