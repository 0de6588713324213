// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>

#include <Eigen/Core>
#include <vector>

namespace glidar::import {

/// Moves every vertex by its own matrix, with normals and tangents. Triangles keep their outer side
/// where matrices mirror.
void apply_skin(const std::vector<Eigen::Matrix4d>& skin, SourceMesh& mesh);

}  // namespace glidar::import
