// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>
#include <glidar/io/model.hpp>

namespace glidar {

/// Turns the chosen axis of the file into z (an exact exchange of coordinates that keeps the
/// handedness: y up becomes (x, -z, y), x up becomes (y, z, x)) and scales to metres.
/// Throws Error unless metres_per_unit is finite and above 0, or when scaling leaves the range of
/// single precision.
void place_mesh(Mesh& mesh, const ModelOptions& options);

}  // namespace glidar
