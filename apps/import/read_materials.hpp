// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/mtl_options.hpp>
#include <import/texture_store.hpp>

#include <glidar/io/model/imported_model.hpp>

struct aiMaterial;

namespace glidar::import {

struct MaterialContext {
  TextureStore& textures;
  const MtlOptions& mtl;  ///< options of Wavefront material files that Assimp ignores
  bool gltf = false;
};

/// Converts a material to the paper's light model. Rules for other models:
///  - ambient missing or black: the diffuse colour;
///  - specular: times the file's strength; none for materials without highlights (Gouraud, flat);
///  - metallic-roughness (glTF): diffuse = base colour; specular = (1 - r) F0 with
///    F0 = mix(0.04, base colour, metallic); shininess = 2 / r^4 - 2 (Karis, Specular BRDF
///    reference, 2013), 0..128;
///  - cut-outs: glTF's MASK with its cutoff; an opacity texture, or a diffuse texture with an alpha
///    flag, with 0.5. Blended transparency is solid.
///  - non-finite numbers become 0, others are clamped to their range.
Material read_material(const aiMaterial& material, const MaterialContext& context, Model& model);

}  // namespace glidar::import
