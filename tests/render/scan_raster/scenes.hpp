// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/scene.hpp>

#include <cstddef>
#include <cstdint>

namespace glidar::testing {

/// A room of 8 m x 8 m x 4 m with objects, seen from its middle.
Scene make_room();

/// Triangles of all shapes anywhere in a cube: needles, duplicates, some without area.
Scene make_soup(std::uint64_t seed, std::size_t count, double size_m);

}  // namespace glidar::testing
