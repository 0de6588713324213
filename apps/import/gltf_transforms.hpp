// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/scene_walk.hpp>

#include <Eigen/Core>
#include <string_view>

namespace glidar::import {

/// The transforms of a glTF file's nodes (.gltf or .glb, glTF 2.0 section 3.5.3) in double: Assimp
/// keeps single precision, which is 5e-4 m off 10 km away. Nodes of the file and of the importer's
/// scene are matched by their places in the tree; where a transform does not agree with the
/// importer's to single precision, or the file cannot be understood, the importer's holds.
NodeTransforms gltf_transforms(std::string_view file, const aiScene& scene);

}  // namespace glidar::import
