// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/material.hpp>

#include <optional>
#include <string>

struct aiMaterial;

namespace glidar::import {

/// A reference to a texture in a material of the file.
struct NamedTexture {
  std::string name;
  TextureUse use;             ///< all but the texture's index
  int flags = 0;              ///< aiTextureFlags
  std::optional<float> bump;  ///< strength, if given in the texture's own line
};

/// The first texture of an aiTextureType of a material; none without one.
/// `gltf`: its transform of uvs is glTF's (KHR_texture_transform), which Assimp rewrites.
std::optional<NamedTexture> texture_of(const aiMaterial& material, unsigned type, bool gltf);

}  // namespace glidar::import
