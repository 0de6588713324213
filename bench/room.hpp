// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/scene.hpp>

namespace glidar::bench {

/// A room of 8 m x 8 m x 4 m, its floor 1.5 m below the origin, and objects on it: 118,784
/// triangles.
Scene make_room();

}  // namespace glidar::bench
