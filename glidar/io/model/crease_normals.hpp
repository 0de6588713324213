// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>

namespace glidar {

/// Computes vertex normals: for each corner the sum of the unit normals of those faces around the
/// position whose angle to the corner's own face is at most the crease angle, weighted by
/// their angle there (Thuermer and Wuethrich, Computing vertex normals from polygonal facets, JGT
/// 3(1), 1998). If corners of one vertex get different normals, the vertex is split;
/// new vertices are appended; triangles keep their order. Degenerate faces contribute nothing.
/// Where more than 512 faces meet with a crease among them every corner keeps its face's normal.
void make_normals(Mesh& mesh, double crease_angle_rad);

}  // namespace glidar
