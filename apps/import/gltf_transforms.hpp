// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <unordered_map>

struct aiNode;
struct aiScene;

namespace glidar::import {

/// parent_from_node of nodes with transforms in more than the importer's single precision.
using NodeTransforms = std::unordered_map<const aiNode*, Eigen::Matrix4d>;

/// The transforms of a glTF file's nodes (.gltf or .glb, glTF 2.0 section 3.5.3) in double: Assimp
/// keeps single precision, with errors of 5e-4 m at 10 km. Nodes of the file and of the importer's
/// scene are matched by their positions in the tree. The importer's transform is used if it differs
/// by more than single precision, or if the file is invalid.
NodeTransforms gltf_transforms(std::string_view file, const aiScene& scene);

}  // namespace glidar::import
