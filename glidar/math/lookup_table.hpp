// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

namespace glidar {

/// A piecewise linear function: pairs (x, value) with increasing x; constant outside them.
using LookupTable = std::vector<std::array<double, 2>>;

/// The value at x, interpolated linearly; `if_empty` for an empty table.
double interpolate(const LookupTable& table, double x, double if_empty = 0.0);

}  // namespace glidar
