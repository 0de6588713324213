// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>

namespace glidar {

/// The plane of a triangle, n . p = offset, in the mesh's frame relative to Mesh::origin_m.
/// n is the unit normal of the front; NaN for a triangle without area.
struct TrianglePlane {
  Eigen::Vector3d normal;
  double offset;
};

/// In double from the mesh's vertices. BlockKernel::intersect computes the same bits.
TrianglePlane plane_of(const Mesh& mesh, std::uint32_t triangle);

}  // namespace glidar
