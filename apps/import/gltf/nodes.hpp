// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/gltf/buffers.hpp>

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace glidar::import::gltf {

/// The nodes of a document, all transforms in double (glTF 2.0, 3.5.3).
struct Nodes {
  std::vector<Eigen::Matrix4d> scene_from_node;  ///< of every node, in the scene or not
  std::vector<std::size_t> shown;                ///< nodes of the scene, depth first, parents first
  std::vector<std::size_t> parent;               ///< of every node; kNoNode: none
};

inline constexpr std::size_t kNoNode = std::numeric_limits<std::size_t>::max();

/// The default scene, else the first one, else all nodes without a parent. Notes other scenes and
/// nodes that are left out. Throws Refusal for nodes that have two parents or are their own
/// ancestors.
Nodes read_nodes(Document& document);

/// The number of copies of a node's mesh (EXT_mesh_gpu_instancing); one without the extension.
std::size_t count_copies(const Document& document, const Value& node);

/// Their transforms.
std::vector<Eigen::Matrix4d> copies_of(Document& document, Buffers& buffers, const Value& node);

/// The affine matrix of 16 numbers by columns. If rounding changed its last row (named `row` in
/// errors) from 0, 0, 0, 1, it is read as that, with a note; others are refused.
Eigen::Matrix4d affine(const double* by_columns, const Value& where, const std::string& row,
                       Notes& notes);

/// The matrix that these parts of a rigid motion and scale give: translation, rotation (x, y, z, w)
/// and scale.
Eigen::Matrix4d composed(const Eigen::Vector3d& translation, const Eigen::Vector4d& rotation,
                         const Eigen::Vector3d& scale);

}  // namespace glidar::import::gltf
