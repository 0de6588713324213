// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>

#include <span>

namespace glidar::import {

/// Appends a face with these corners (vertices, at least three) to the triangles of the mesh.
/// Quadrilaterals are split at their concave corner, others by clipping ears. Returns false if the
/// polygon intersects itself: parts of it are left out.
bool add_face(SourceMesh& mesh, std::span<const std::uint32_t> corners);

/// The note about such polygons; nothing for none.
void note_intersecting(SourceModel& source, std::size_t polygons);

}  // namespace glidar::import
