// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/gltf/buffers.hpp>
#include <import/source_model.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace glidar::import::gltf {

/// The texture coordinates of a material's meshes: TEXCOORD_n of its two sets.
struct UvSets {
  std::array<std::size_t, 2> sets = {0, 1};
  std::array<bool, 2> needed = {false, false};  ///< by a texture
};

/// Reads all materials into the model, in the file's order, with their images; notes what the light
/// model has no place for:
///  - metallic-roughness: diffuse = base colour; specular = (1 - r) F0 with
///    F0 = mix(((ior - 1) / (ior + 1))^2, base colour, metallic) and the factors of
///    KHR_materials_specular; shininess = 2 / r^4 - 2 (Karis, Specular BRDF reference, 2013),
///    0..128. Its texture is left out;
///  - KHR_materials_pbrSpecularGlossiness: the same with r = 1 - glossiness and its own F0;
///  - KHR_materials_unlit: no highlights;
///  - emitted light and occlusion are left out.
/// The last material is that of primitives without one. Returns the sets of each.
std::vector<UvSets> read_materials(Document& document, Buffers& buffers, SourceModel& model);

}  // namespace glidar::import::gltf
