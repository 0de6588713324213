// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/material.hpp>

#include <optional>
#include <string>

struct aiMaterial;

namespace glidar::import {

/// A texture as a material of the file names it.
struct NamedTexture {
  std::string name;
  TextureUse use;             ///< all but the texture's index
  int flags = 0;              ///< aiTextureFlags
  std::optional<float> bump;  ///< strength, where the texture's own line tells it
};

/// The first texture of an aiTextureType of a material; none when it has none.
/// `gltf`: its transform of uvs is glTF's (KHR_texture_transform), which Assimp rewrites.
std::optional<NamedTexture> texture_of(const aiMaterial& material, unsigned type, bool gltf);

}  // namespace glidar::import
