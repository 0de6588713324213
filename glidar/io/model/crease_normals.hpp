// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>

namespace glidar {

/// Makes vertex normals: for each corner the sum of the unit normals of those faces around the
/// position that lean from the corner's own face by no more than the crease angle, weighted by
/// their angle there (Thuermer and Wuethrich, Computing vertex normals from polygonal facets, JGT
/// 3(1), 1998). Corners of one vertex that come to different normals get vertices of their own,
/// added at the end; triangles and their order stay. Degenerate faces add nothing. Where more than
/// 512 faces meet with a crease among them every corner keeps its face's normal.
void make_normals(Mesh& mesh, double crease_angle_rad);

}  // namespace glidar
