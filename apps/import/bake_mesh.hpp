// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>

#include <glidar/io/model/mesh_blob.hpp>

#include <cstdint>
#include <vector>

namespace glidar::import {

/// Fills the model's mesh, parts, content and notes from the placed meshes: node transforms applied
/// in double, triangles with NaN or infinity left out, the winding of mirrored parts reversed.
/// Origins are those of part_origins(). `slot_of_material`: the file's material -> slot of
/// `model`, which has its materials. Frees the meshes of `source`. Throws Refusal when no triangle
/// is left.
void bake(SourceModel& source, double crease_angle_rad,
          const std::vector<std::uint16_t>& slot_of_material, Model& model);

}  // namespace glidar::import
