// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/scene_walk.hpp>

#include <glidar/io/model/imported_model.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace glidar::import {

/// What a mesh needs to know of its material.
struct SlotNeeds {
  bool tangents = false;      ///< it has a normal map
  std::size_t normal_uv = 0;  ///< in this uv set
};

struct BakeOptions {
  double crease_angle_rad = 0.0;
  bool facet_normals = false;  ///< the file's normals are its facets' (STL): as good as none
  std::vector<std::uint16_t> slot_of_material;  ///< the file's material -> slot
  std::vector<SlotNeeds> needs;                 ///< of each slot
};

/// Fills the model's mesh, parts and notes from the placed meshes: node transforms applied in
/// double, triangles that touch NaN or infinity left out, the fronts of mirrored parts turned back.
/// Origins are those of part_origins(). Throws Refusal when no triangle is left.
void bake(const Walk& walk, const BakeOptions& options, Model& model);

}  // namespace glidar::import
