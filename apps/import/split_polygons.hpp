// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

struct aiScene;

namespace glidar::import {

/// Splits the polygons with more than four corners into triangles by clipping ears. Assimp's own
/// step leaves holes beside corners on a straight line (5.4), and its result depends on its
/// version. Returns the number of polygons that intersect themselves, parts of which are left out.
std::size_t split_polygons(aiScene& scene);

}  // namespace glidar::import
