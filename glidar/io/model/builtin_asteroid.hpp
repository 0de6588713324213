// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/model/point_mesh.hpp>

namespace glidar {

/// A cratered rock about 2 m long in x, of 81,920 triangles; its centre of volume is the origin.
PointMesh make_asteroid();

}  // namespace glidar
