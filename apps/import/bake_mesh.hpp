// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/scene_walk.hpp>

#include <glidar/io/model/imported_model.hpp>

#include <cstdint>
#include <vector>

namespace glidar::import {

/// The properties of a material that its meshes need.
struct SlotNeeds {
  bool tangents = false;      ///< it has a normal map
  std::size_t normal_uv = 0;  ///< in this uv set
};

struct BakeOptions {
  double crease_angle_rad = 0.0;
  bool facet_normals = false;  ///< the file has facet normals only (STL), which are not used
  std::vector<std::uint16_t> slot_of_material;  ///< the file's material -> slot
  std::vector<SlotNeeds> needs;                 ///< of each slot
};

/// Fills the model's mesh, parts and notes from the placed meshes: node transforms applied in
/// double, triangles with NaN or infinity left out, the winding of mirrored parts reversed.
/// Origins are those of part_origins(). Throws Refusal when no triangle is left.
void bake(const Walk& walk, const BakeOptions& options, Model& model);

}  // namespace glidar::import
