// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>

#include <cstddef>

namespace glidar {

/// Makes vertex tangents from normals and one uv set, as MikkTSpace does in spirit (Mikkelsen,
/// Simulation of wrinkled surfaces revisited, 2008): per corner the face's +u direction, laid into
/// the plane of the vertex normal, summed by angle. A vertex between faces of mirrored and
/// unmirrored uvs gets one vertex for each. Needs normals and uvs; triangles and their order stay.
void make_tangents(Mesh& mesh, std::size_t uv_set);

}  // namespace glidar
