// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/confined_io.hpp>
#include <import/model_files.hpp>

#include <filesystem>

namespace glidar::import {

/// Replaces a glTF file, for the importer, by one without extensions that Assimp does not support
/// well:
///  - KHR_draco_mesh_compression: the meshes are decoded;
///  - KHR_texture_basisu: textures without another image refer to the KTX2 image itself, which is
///    then reported as a texture that cannot be read.
/// Throws Refusal for EXT_meshopt_compression. Other files, and invalid ones, are unchanged.
void replace_gltf_extensions(const std::filesystem::path& canonical_model,
                             const ModelFolder& folder, ModelFiles& files, FileLog& log);

}  // namespace glidar::import
