// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>
#include <glidar/io/model/model.hpp>

namespace glidar {

/// Turns the up axis of the file into z (an exact exchange of coordinates that keeps the
/// handedness: y up becomes (x, -z, y), x up becomes (y, z, x)), scales to metres, and, with
/// `centre`, moves the middle of the box to the origin (exactly: only the mesh's origin changes).
/// Throws Error unless the unit is finite and above 0, or when scaling leaves the range of single
/// precision.
void place_mesh(Mesh& mesh, const ModelFrame& frame, bool centre);

/// The mesh with every coordinate multiplied by its axis' factor, which is above 0. Normals are
/// those of the stretched surface (inverse transpose), tangents run along it.
/// Throws Error when it leaves the range of single precision.
Mesh stretched(const Mesh& mesh, const Eigen::Vector3d& factors);

}  // namespace glidar
