// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>
#include <glidar/io/model/model.hpp>

namespace glidar {

/// Makes the file's up axis z (an exact permutation of coordinates that preserves
/// handedness: y up becomes (x, -z, y), x up becomes (y, z, x)), scales to metres, and, with
/// `centre`, moves the centre of the bounding box to the origin (exactly: only the mesh's origin
/// changes). The frames of its nodes move with it. Throws Error unless the unit is finite and
/// positive, or when scaling exceeds the range of single precision.
void apply_model_frame(Model& model, const ModelFrame& frame, bool centre);

/// A copy of the mesh with every coordinate multiplied by its axis' factor, which is not 0. Normals
/// are those of the scaled surface (inverse transpose), tangents are tangential to it; a mirrored
/// mesh keeps its front outside.
/// Throws Error when it exceeds the range of single precision.
Mesh scaled_copy(const Mesh& mesh, const Eigen::Vector3d& factors);

}  // namespace glidar
