// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>

struct aiMaterial;

namespace glidar::import {

/// Converts a material of Assimp to the paper's light model. Rules for other models:
///  - ambient missing or black: the diffuse colour;
///  - specular: times the file's strength; none for materials without highlights (Gouraud, flat);
///  - metallic-roughness: diffuse = base colour; specular = (1 - r) F0 with
///    F0 = mix(0.04, base colour, metallic); shininess = 2 / r^4 - 2 (Karis, Specular BRDF
///    reference, 2013), 0..128;
///  - non-finite numbers become 0, others are clamped to their range.
SourceMaterial assimp_material(const aiMaterial& material);

}  // namespace glidar::import
