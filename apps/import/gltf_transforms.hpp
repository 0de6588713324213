// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/scene_walk.hpp>

#include <Eigen/Core>
#include <string_view>

namespace glidar::import {

/// The transforms of a glTF file's nodes (.gltf or .glb, glTF 2.0 section 3.5.3) in double: Assimp
/// keeps single precision, with errors of 5e-4 m at 10 km. Nodes of the file and of the importer's
/// scene are matched by their positions in the tree. The importer's transform is used if it differs
/// by more than single precision, or if the file is invalid.
NodeTransforms gltf_transforms(std::string_view file, const aiScene& scene);

}  // namespace glidar::import
