// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

/// For meshes with coincident triangles (same corners in any order): the first of each group, per
/// triangle, so that every renderer reports the same one. Empty when there are none.
std::vector<std::uint32_t> find_first_coincident(const Mesh& mesh);

/// The triangles of a mesh without copies, which have the same corners and winding as an earlier
/// one. Rising indices; empty when there are no copies. `firsts`: find_first_coincident(mesh).
std::vector<std::uint32_t> distinct_triangles(const Mesh& mesh,
                                              const std::vector<std::uint32_t>& firsts);

}  // namespace glidar
