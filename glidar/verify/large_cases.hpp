// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/verify/special_cases.hpp>

#include <vector>

namespace glidar {

/// Casts of more than 100,000 beams, scenes of 1,000 instances, meshes of more than 100,000
/// triangles with vertex normals, and culled back faces. The shapes must outlive the cases.
void add_large_cases(const std::vector<Shape>& shapes, std::vector<SpecialCase>& cases);

}  // namespace glidar
