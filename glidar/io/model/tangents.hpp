// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>

#include <cstddef>

namespace glidar {

/// Computes vertex tangents from normals and one uv set, similar to MikkTSpace (Mikkelsen,
/// Simulation of wrinkled surfaces revisited, 2008): per corner the face's +u direction, projected
/// onto the plane of the vertex normal, weighted by angle. A vertex between faces of mirrored and
/// unmirrored uvs is split. Requires normals and uvs; triangles keep their order.
void make_tangents(Mesh& mesh, std::size_t uv_set);

}  // namespace glidar
