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
  const MtlOptions& mtl;  ///< what Assimp leaves unread of Wavefront material files
  bool gltf = false;
};

/// One material of the file by the paper's light model. Rules where formats say more or other:
///  - ambient missing or black: the diffuse colour;
///  - specular: times the file's strength; none for materials without highlights (Gouraud, flat);
///  - metallic-roughness (glTF): diffuse = base colour; specular = (1 - r) F0 with
///    F0 = mix(0.04, base colour, metallic); shininess = 2 / r^4 - 2 (Karis, Specular BRDF
///    reference, 2013), 0..128;
///  - cut-outs: glTF's MASK by its cutoff; an opacity texture, or a diffuse one whose alpha the
///    material says to use, by 0.5. Blended transparency stays solid.
///  - numbers that are not finite become 0, all are brought into their range.
Material read_material(const aiMaterial& material, const MaterialContext& context, Model& model);

}  // namespace glidar::import
